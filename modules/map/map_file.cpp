// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_file.hpp"

#include <stdexcept>

#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/log.hpp"

namespace planemap::map {

std::string plane_map_log(const PlaneMap& map) {
    messages::LogEvent event;
    event.utime = map.utime;
    event.channel = messages::channels::kMap;
    event.bytes = messages::to_bytes(messages::to_message(map, 0));
    return messages::encode_event(event);
}

void write_plane_map(const std::filesystem::path& file, const PlaneMap& map) {
    write_file(file, plane_map_log(map));
}

PlaneMap read_plane_map(const std::filesystem::path& file) {
    messages::LogReader log(file);
    std::vector<std::uint8_t> newest;
    bool found = false;
    for (messages::LogEvent event; log.next(event);) {
        if (event.channel != messages::channels::kMap) continue;
        newest = std::move(event.bytes);
        found = true;
    }
    if (log.truncated()) throw std::runtime_error(file.string() + ": is cut short");
    if (log.bytes_skipped() > 0)
        throw std::runtime_error(file.string() + ": " + std::to_string(log.bytes_skipped()) +
                                 " bytes of it are no LCM log");
    if (!found)
        throw std::runtime_error(file.string() + ": holds no map (nothing on " + messages::channels::kMap +
                                 ")");
    try {
        return messages::plane_map_from(newest);
    } catch (const messages::OtherTypeError& error) {
        throw std::runtime_error(
            file.string() +
            ": its map is in the format of another planemap, which this one does not read: " + error.what());
    } catch (const messages::MessageError& error) {
        throw std::runtime_error(file.string() + ": its map is corrupt: " + error.what());
    }
}

bool may_hold_planes(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return false;
    try {
        return !read_plane_map(file).planes.empty();
    } catch (const std::exception&) {
        return true;
    }
}

}  // namespace planemap::map
