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
static_assert(sizeof(Header) == 24 && sizeof(Record) == 28);

constexpr std::uint32_t kEnd = 11;
/// What OpenNI2's player has room for.
constexpr std::uint32_t kMaxPayload = 1600 * 1200 * 3, kMaxFields = 1 << 20;

}  // namespace

void check_oni_file(const std::filesystem::path& file) {
    const auto fail = [&](const std::string& what) { throw std::runtime_error(file.string() + ": " + what); };
    std::ifstream in(file, std::ios::binary);
    if (!in) fail("cannot be read");
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof(header));
    if (!in || std::memcmp(header.magic, "NI10", 4) != 0) fail("is no OpenNI recording");
    if (header.major != 1 || header.maintenance < 1)
        fail("is a recording of an OpenNI that is too old (format 1.0.0)");
    std::uint64_t place = sizeof(Header);
    const std::uint64_t size = std::filesystem::file_size(file);
    for (;;) {
        Record record{};
        in.seekg(static_cast<std::streamoff>(place));
        in.read(reinterpret_cast<char*>(&record), sizeof(record));
        const std::string at = " at byte " + std::to_string(place);
        if (!in) fail("is cut short" + at + ": the recording was not closed");
        if (std::memcmp(record.magic, "NIR\0", 4) != 0 || record.fields_size < sizeof(Record) ||
            record.fields_size > kMaxFields || record.payload_size > kMaxPayload)
            fail("is damaged" + at + ": no record begins there");
        if (record.type == kEnd) return;
        place += record.fields_size + record.payload_size;
        if (place > size) fail("is cut short" + at + ": the recording was not closed");
    }
}

}  // namespace planemap::camera
