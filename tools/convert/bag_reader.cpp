// SPDX-License-Identifier: BSD-3-Clause
#include "convert/bag_reader.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace planemap::convert {

namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxHeader = 1 << 20, kMaxConnection = 1 << 24, kMaxChunk = 1 << 29;
constexpr std::size_t kMaxConnections = 10000;

enum Op : std::uint8_t {
    kMessage = 2,
    kBagHeader = 3,
    kIndex = 4,
    kChunk = 5,
    kChunkInfo = 6,
    kConnection = 7
};

template <typename T>
T number_at(std::span<const std::uint8_t> bytes, std::size_t at = 0) {
    T value;
    if (at > bytes.size() || bytes.size() - at < sizeof(T)) throw std::runtime_error("a field is cut short");
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// "name=value" fields, each with its length before it.
class Fields {
  public:
    explicit Fields(std::span<const std::uint8_t> header) {
        for (std::size_t at = 0; at < header.size();) {
            const std::size_t size = number_at<std::uint32_t>(header, at);
            at += 4;
            if (size > header.size() - at) throw std::runtime_error("a field is cut short");
            const auto field = header.subspan(at, size);
            const auto sign = std::find(field.begin(), field.end(), std::uint8_t{'='});
            if (sign == field.end()) throw std::runtime_error("a field without a name");
            const auto name_size = static_cast<std::size_t>(sign - field.begin());
            fields_[std::string(field.begin(), sign)] = field.subspan(name_size + 1);
            at += size;
        }
    }
    template <typename T>
    T number(const std::string& name) const {
        const auto found = fields_.find(name);
        if (found == fields_.end()) throw std::runtime_error("no field " + name);
        return number_at<T>(found->second);
    }
    std::string text(const std::string& name) const {
        const auto found = fields_.find(name);
        return found == fields_.end() ? "" : std::string(found->second.begin(), found->second.end());
    }

  private:
    std::map<std::string, std::span<const std::uint8_t>> fields_;
};

std::int64_t nanoseconds(std::uint64_t time) {
    return static_cast<std::int64_t>(time & 0xffffffff) * 1000000000 + static_cast<std::int64_t>(time >> 32);
}

/// Decompressed bytes as they come: what a hostile size says is never taken beforehand.
class Growing {
  public:
    explicit Growing(std::uint32_t most) : most_(most) {}
    std::span<std::uint8_t> room() {
        constexpr std::size_t kStep = 1 << 20;
        if (used_ == bytes_.size())
            bytes_.resize(std::min<std::size_t>(most_, used_ + std::max(kStep, used_)));
        return std::span(bytes_).subspan(used_);
    }
    void use(std::size_t count) { used_ += count; }
    bool is_full() const { return used_ == most_; }
    std::vector<std::uint8_t> take() {
        bytes_.resize(used_);
        return std::move(bytes_);
    }

  private:
    std::uint32_t most_;
    std::size_t used_ = 0;
    std::vector<std::uint8_t> bytes_;
};

std::vector<std::uint8_t> from_bz2(std::vector<std::uint8_t>& stored, std::uint32_t size) {
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
    const auto end = [](bz_stream* s) { BZ2_bzDecompressEnd(s); };
    const std::unique_ptr<bz_stream, decltype(end)> guard(&stream, end);
    stream.next_in = reinterpret_cast<char*>(stored.data());
    stream.avail_in = static_cast<unsigned>(stored.size());
    Growing out(size);
    for (int status = BZ_OK; status == BZ_OK && !out.is_full();) {
        const auto room = out.room();
        stream.next_out = reinterpret_cast<char*>(room.data());
        stream.avail_out = static_cast<unsigned>(room.size());
        const unsigned in_before = stream.avail_in;
        status = BZ2_bzDecompress(&stream);
        const std::size_t made = room.size() - stream.avail_out;
        out.use(made);
        if (made == 0 && stream.avail_in == in_before) break;
    }
    if (!out.is_full()) throw std::runtime_error("a bz2 chunk is damaged");
    return out.take();
}

std::vector<std::uint8_t> from_lz4(const std::vector<std::uint8_t>& stored, std::uint32_t size) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
    const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> guard(
        context, LZ4F_freeDecompressionContext);
    Growing out(size);
    std::size_t at = 0;
    while (!out.is_full()) {
        const auto room = out.room();
        std::size_t made = room.size(), used = stored.size() - at;
        const std::size_t status =
            LZ4F_decompress(context, room.data(), &made, stored.data() + at, &used, nullptr);
        if (LZ4F_isError(status) != 0 || (made == 0 && used == 0)) break;
        out.use(made);
        at += used;
    }
    if (!out.is_full()) throw std::runtime_error("an lz4 chunk is damaged");
    return out.take();
}

}  // namespace

/// A record's place in the file or in a chunk.
struct BagReader::Record {
    std::vector<std::uint8_t> header;
    std::uint64_t data_at = 0;
    std::uint32_t data_size = 0;
    std::uint64_t end() const { return data_at + data_size; }
};

BagReader::BagReader(const std::filesystem::path& file) : file_(file) {
    std::string magic(kMagic.size(), '\0');
    if (file_.size() >= magic.size())
        file_.read(0, {reinterpret_cast<std::uint8_t*>(magic.data()), magic.size()});
    if (magic != kMagic) throw std::runtime_error(file.string() + ": is no ROS 1 bag of format 2.0");
    try {
        scan();
    } catch (const std::runtime_error& error) {
        const std::string what = error.what();
        throw std::runtime_error(what.starts_with(file.string()) ? what : file.string() + ": " + what);
    }
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.time_ns < b.time_ns; });
}

/// All records of the file; a chunk's messages by the index behind it, or, without one, out of the chunk.
void BagReader::scan() {
    std::uint64_t at = kMagic.size();
    while (file_.size() - at >= 8) {
        std::uint8_t length[4];
        Record record;
        file_.read(at, length);
        const auto header_size = number_at<std::uint32_t>(length);
        if (header_size > kMaxHeader || header_size + 8 > file_.size() - at) break;
        record.header.resize(header_size);
        file_.read(at + 4, record.header);
        file_.read(at + 4 + header_size, length);
        record.data_size = number_at<std::uint32_t>(length);
        record.data_at = at + 8 + header_size;
        if (record.data_size > file_.size() - record.data_at) break;
        try {
            scan_record(record);
        } catch (const std::runtime_error& error) {
            if (std::string_view(error.what()).starts_with(file_.path().string()))
                throw;  // the disk, not the bag
            break;
        }
        at = record.end();
    }
    whole_until_ = at;
    const bool unknown = std::any_of(entries_.begin(), entries_.end(),
                                     [&](const Entry& e) { return topics_.count(e.connection) == 0; });
    for (std::uint32_t i = 0; i < chunks_.size(); ++i)
        if (unknown || !chunks_[i].indexed) scan_chunk(i);
}

void BagReader::scan_record(const Record& record) {
    const Fields fields(record.header);
    switch (fields.number<std::uint8_t>("op")) {
        case kBagHeader:
            if (!fields.text("encryptor").empty())
                throw std::runtime_error(file_.path().string() + ": is encrypted by " +
                                         fields.text("encryptor"));
            break;
        case kChunk:
            chunks_.push_back({record.data_at, record.data_size, fields.number<std::uint32_t>("size"),
                               fields.text("compression"), false});
            if (chunks_.back().size > kMaxChunk) throw std::runtime_error("a chunk is too large");
            break;
        case kIndex:
            scan_index(record);
            break;
        case kConnection: {
            if (record.data_size > kMaxConnection) throw std::runtime_error("a connection is too large");
            std::vector<std::uint8_t> data(record.data_size);
            file_.read(record.data_at, data);
            add_connection(record, data);
            break;
        }
        default:
            break;
    }
}

void BagReader::add_connection(const Record& record, std::span<const std::uint8_t> data) {
    if (topics_.size() >= kMaxConnections) throw std::runtime_error("too many connections");
    const Fields fields(record.header);
    const std::string topic = fields.text("topic");
    topics_[fields.number<std::uint32_t>("conn")] = topic;
    types_[topic] = Fields(data).text("type");
}

void BagReader::scan_index(const Record& record) {
    constexpr std::size_t kEntry = 12;
    if (chunks_.empty()) throw std::runtime_error("an index before the first chunk");
    const Fields fields(record.header);
    const auto connection = fields.number<std::uint32_t>("conn");
    std::vector<std::uint8_t> data(record.data_size);
    file_.read(record.data_at, data);
    for (std::size_t at = 0; at + kEntry <= data.size(); at += kEntry) {
        entries_.push_back({nanoseconds(number_at<std::uint64_t>(data, at)), connection,
                            static_cast<std::uint32_t>(chunks_.size() - 1),
                            number_at<std::uint32_t>(data, at + 8)});
    }
    chunks_.back().indexed = true;
}

namespace {

struct Inner {
    std::span<const std::uint8_t> header, data;
    std::size_t end = 0;
};

/// The record at a place in a chunk; nothing if there is none that is whole.
std::optional<Inner> inner_record(std::span<const std::uint8_t> chunk, std::size_t at) {
    if (at > chunk.size() || chunk.size() - at < 8) return std::nullopt;
    const std::size_t header_size = number_at<std::uint32_t>(chunk, at);
    if (header_size > chunk.size() - at - 8) return std::nullopt;
    const std::size_t data_size = number_at<std::uint32_t>(chunk, at + 4 + header_size);
    const std::size_t data_at = at + 8 + header_size;
    if (data_size > chunk.size() - data_at) return std::nullopt;
    return Inner{chunk.subspan(at + 4, header_size), chunk.subspan(data_at, data_size), data_at + data_size};
}

}  // namespace

/// Connections and, without an index, messages of a chunk. A chunk that is damaged gives those before.
void BagReader::scan_chunk(std::uint32_t chunk) {
    try {
        const std::vector<std::uint8_t>& bytes = chunk_bytes(chunk);
        std::size_t at = 0;
        for (auto record = inner_record(bytes, at); record; record = inner_record(bytes, at)) {
            const Fields fields(record->header);
            const auto op = fields.number<std::uint8_t>("op");
            if (op == kConnection) {
                add_connection({{record->header.begin(), record->header.end()}, 0, 0}, record->data);
            } else if (op == kMessage && !chunks_[chunk].indexed) {
                entries_.push_back({nanoseconds(fields.number<std::uint64_t>("time")),
                                    fields.number<std::uint32_t>("conn"), chunk,
                                    static_cast<std::uint32_t>(at)});
            }
            at = record->end;
        }
    } catch (const std::runtime_error& error) {
        if (fault_.empty()) fault_ = error.what();
    }
}

const std::vector<std::uint8_t>& BagReader::chunk_bytes(std::uint32_t index) {
    if (is_cached_ && cached_chunk_ == index) return cached_;
    is_cached_ = false;
    const Chunk& chunk = chunks_[index];
    std::vector<std::uint8_t> stored(chunk.stored);
    file_.read(chunk.at, stored);
    if (chunk.compression == "none") {
        cached_ = std::move(stored);
    } else if (chunk.compression == "bz2") {
        cached_ = from_bz2(stored, chunk.size);
    } else if (chunk.compression == "lz4") {
        cached_ = from_lz4(stored, chunk.size);
    } else {
        throw std::runtime_error("compression \"" + chunk.compression + "\" is not none, bz2 or lz4");
    }
    cached_chunk_ = index;
    is_cached_ = true;
    return cached_;
}

void BagReader::select(const std::vector<std::string>& topics) {
    selected_.clear();
    next_ = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto topic = topics_.find(entries_[i].connection);
        if (topic != topics_.end() && std::find(topics.begin(), topics.end(), topic->second) != topics.end())
            selected_.push_back(i);
    }
}

bool BagReader::read(const Entry& entry, BagMessage& message) {
    try {
        const auto record = inner_record(chunk_bytes(entry.chunk), entry.offset);
        if (!record) throw std::runtime_error("a message reaches beyond its chunk");
        const Fields fields(record->header);
        if (fields.number<std::uint8_t>("op") != kMessage ||
            fields.number<std::uint32_t>("conn") != entry.connection)
            throw std::runtime_error("the index is not that of its chunk");
        message.topic = topics_.at(entry.connection);
        message.utime = entry.time_ns / 1000;
        message.bytes.assign(record->data.begin(), record->data.end());
        return true;
    } catch (const std::runtime_error& error) {
        if (unreadable_++ == 0) fault_ = error.what();
        return false;
    }
}

bool BagReader::next(BagMessage& message) {
    while (next_ < selected_.size())
        if (read(entries_[selected_[next_++]], message)) return true;
    return false;
}

std::vector<std::string> BagReader::complaints() const {
    const std::string name = file_.path().string();
    std::vector<std::string> lines;
    if (whole_until_ < file_.size()) {
        lines.push_back(name + ": the bag is whole up to byte " + std::to_string(whole_until_) + " of " +
                        std::to_string(file_.size()) + "; what follows is not read");
    }
    if (unreadable_ > 0 || !fault_.empty())
        lines.push_back(name + ": " + std::to_string(unreadable_) + " messages cannot be read: " + fault_);
    return lines;
}

}  // namespace planemap::convert
