// SPDX-License-Identifier: BSD-3-Clause
#include "camera/oni_file.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

namespace planemap::camera {

namespace {

/// All little-endian: magic, version, time of the last frame, greatest node id.
struct [[gnu::packed]] Header {
    char magic[4];
    std::uint8_t major, minor;
    std::uint16_t maintenance;
    std::uint32_t build;
    std::uint64_t last_us;
    std::uint32_t nodes;
};
struct [[gnu::packed]] Record {
    char magic[4];
    std::uint32_t type, node, fields_size, payload_size;
    std::uint64_t undo_place;
};
/// Of a node's record, behind its name, type and codec.
struct [[gnu::packed]] NodeFrames {
    std::uint32_t count;
    std::uint64_t first_us, last_us, table_place;  ///< of the table of its frames; 0: none
};
static_assert(sizeof(Header) == 24 && sizeof(Record) == 28 && sizeof(NodeFrames) == 28);

constexpr std::uint32_t kNewData = 10, kEnd = 11, kNode = 13;
/// What OpenNI2's player has room for.
constexpr std::uint32_t kMaxPayload = 1600 * 1200 * 3, kMaxFields = 1 << 20;

/// Where the NodeFrames of a node's record are.
std::uint64_t place_of_frames(std::istream& in, std::uint64_t record) {
    std::uint32_t name_size = 0;
    in.seekg(static_cast<std::streamoff>(record + sizeof(Record)));
    in.read(reinterpret_cast<char*>(&name_size), sizeof(name_size));
    return record + sizeof(Record) + sizeof(name_size) + name_size + 8;
}

}  // namespace

void OniWalk::fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ": " + what);
}

void OniWalk::go_on() {
    std::ifstream in(file_, std::ios::binary);
    if (!in) fail("cannot be read");
    const std::uint64_t size = std::filesystem::file_size(file_);
    if (place_ == 0) {
        Header header{};
        in.read(reinterpret_cast<char*>(&header), sizeof(header));
        if (!in || std::memcmp(header.magic, "NI10", 4) != 0) fail("is no OpenNI recording");
        if (header.major != 1 || header.maintenance < 1)
            fail("is a recording of an OpenNI that is too old (format 1.0.0)");
        place_ = sizeof(Header);
    }
    while (!is_at_end_) {
        Record record{};
        in.seekg(static_cast<std::streamoff>(place_));
        in.read(reinterpret_cast<char*>(&record), sizeof(record));
        if (!in) return;
        if (std::memcmp(record.magic, "NIR\0", 4) != 0 || record.fields_size < sizeof(Record) ||
            record.fields_size > kMaxFields || record.payload_size > kMaxPayload)
            fail("is damaged at byte " + std::to_string(place_) + ": no record begins there");
        is_at_end_ = record.type == kEnd;
        if (record.type == kNode) nodes_[record.node] = {place_of_frames(in, place_), 0};
        const bool is_new =
            record.type == kNewData && place_ + record.fields_size + record.payload_size <= size;
        if (const auto node = nodes_.find(record.node); is_new && node != nodes_.end()) ++node->second.frames;
        const std::uint64_t next = place_ + record.fields_size + record.payload_size;
        if (is_at_end_ || next > size) return;
        place_ = next;
    }
}

void OniWalk::finish() const {
    std::fstream both(file_, std::ios::binary | std::ios::in | std::ios::out);
    for (const auto& [id, node] : nodes_) {
        NodeFrames named{};
        both.seekg(static_cast<std::streamoff>(node.frames_place));
        both.read(reinterpret_cast<char*>(&named), sizeof(named));
        if (named.count == node.frames) continue;
        named.count = node.frames;
        named.table_place = 0;  // none: the player refuses one of another length
        both.seekp(static_cast<std::streamoff>(node.frames_place));
        both.write(reinterpret_cast<const char*>(&named), sizeof(named));
    }
    both.close();
    if (!both) fail("cannot be written");
    std::filesystem::resize_file(file_, place_ + sizeof(Record));
}

void check_oni_file(const std::filesystem::path& file) {
    OniWalk walk(file);
    walk.go_on();
    if (!walk.is_at_end())
        throw std::runtime_error(file.string() + ": is cut short at byte " + std::to_string(walk.place()) +
                                 ": the recording was not closed");
}

}  // namespace planemap::camera
