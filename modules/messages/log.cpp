// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace planemap {

namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeader = 4 + 8 + 8 + 4 + 4;
constexpr std::uint32_t kMaxChannel = 256;  // liblcm allows 63

template <typename T>
T big_endian(const std::uint8_t* bytes) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | bytes[i]);
    return value;
}

template <typename T>
void append(std::string& out, T value) {
    for (std::size_t i = sizeof(T); i-- > 0;) out += static_cast<char>(value >> (8 * i) & 0xff);
}

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing, int error) {
    throw std::runtime_error(file.string() + ": cannot " + doing + ": " + std::strerror(error));
}

std::FILE* opened(const std::filesystem::path& file, const char* mode) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) fail(file, "open", EISDIR);
    std::FILE* handle = std::fopen(file.c_str(), mode);
    if (handle == nullptr) fail(file, "open", errno);
    return handle;
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : file_(opened(file, "rb")) {
    std::error_code error;
    size_ = std::filesystem::file_size(file, error);
    if (error) fail(file, "read", error.value());
}

bool LogReader::next(LogEvent& event) {
    while (at_ < size_) {
        const std::uint64_t start = at_;
        if (read_record(event)) return true;
        // Not a record here: look for the next sync word, one byte on.
        at_ = start + 1;
        std::array<std::uint8_t, 65536> block;
        bool found = false;
        while (!found && at_ + 4 <= size_) {
            std::fseek(file_.get(), static_cast<long>(at_), SEEK_SET);
            const std::size_t got = std::fread(block.data(), 1, block.size(), file_.get());
            if (got < 4) break;
            std::size_t i = 0;
            while (i + 4 <= got && big_endian<std::uint32_t>(&block[i]) != kSync) ++i;
            found = i + 4 <= got;
            at_ += i;
        }
        if (!found) at_ = size_;
        skipped_ += at_ - start;
    }
    return false;
}

/// Reads the record at at_ and moves behind it; false, wherever at_ then is, if there is none.
bool LogReader::read_record(LogEvent& event) {
    std::array<std::uint8_t, kHeader> header;
    std::fseek(file_.get(), static_cast<long>(at_), SEEK_SET);
    const std::size_t got = std::fread(header.data(), 1, kHeader, file_.get());
    if (got < 4 || big_endian<std::uint32_t>(header.data()) != kSync) return false;
    if (got < kHeader) {
        truncated_ = true;
        return false;
    }
    const auto channel_length = big_endian<std::uint32_t>(&header[20]);
    const auto data_length = big_endian<std::uint32_t>(&header[24]);
    if (channel_length == 0 || channel_length > kMaxChannel || data_length > 0x7fffffffu) return false;
    if (std::uint64_t{kHeader} + channel_length + data_length > size_ - at_) {
        truncated_ = true;
        return false;
    }
    event.number = big_endian<std::int64_t>(&header[4]);
    event.utime = big_endian<std::int64_t>(&header[12]);
    event.channel.resize(channel_length);
    event.bytes.resize(data_length);
    if (std::fread(event.channel.data(), 1, channel_length, file_.get()) != channel_length) return false;
    if (std::fread(event.bytes.data(), 1, data_length, file_.get()) != data_length) return false;
    at_ += kHeader + channel_length + data_length;
    truncated_ = false;  // whatever looked cut short was a stray sync word
    return true;
}

std::string encode_event(const LogEvent& event) {
    std::string out;
    out.reserve(kHeader + event.channel.size() + event.bytes.size());
    append(out, kSync);
    append(out, static_cast<std::uint64_t>(event.number));
    append(out, static_cast<std::uint64_t>(event.utime));
    append(out, static_cast<std::uint32_t>(event.channel.size()));
    append(out, static_cast<std::uint32_t>(event.bytes.size()));
    out += event.channel;
    out.append(event.bytes.begin(), event.bytes.end());
    return out;
}

LogWriter::LogWriter(const std::filesystem::path& file) : path_(file), file_(opened(file, "wb")) {}

void LogWriter::write(const LogEvent& event) {
    const std::string bytes = encode_event(event);
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail(path_, "write", errno);
}

void LogWriter::close() {
    std::FILE* file = file_.release();
    if (file != nullptr && std::fclose(file) != 0) fail(path_, "write", errno);
}

}  // namespace planemap
