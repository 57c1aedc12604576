// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_file.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"

namespace planemap::map {

namespace {

std::string event_of(std::int64_t number, std::int64_t utime, const char* channel,
                     std::vector<std::uint8_t> bytes) {
    messages::LogEvent event;
    event.number = number;
    event.utime = utime;
    event.channel = channel;
    event.bytes = std::move(bytes);
    return messages::encode_event(event);
}

/// The last map in a file, and what was seen to be empty; empty where there is none.
struct Stored {
    std::vector<std::uint8_t> map, seen;
};

Stored read(const std::filesystem::path& file) {
    messages::LogReader log(file);
    Stored stored;
    for (messages::LogEvent event; log.next(event);) {
        if (event.channel == messages::channels::kMap)
            stored = {std::move(event.bytes), {}};
        else if (event.channel == messages::channels::kSeenSpace)
            stored.seen = std::move(event.bytes);
    }
    if (log.truncated()) throw std::runtime_error(file.string() + ": is cut short");
    if (log.bytes_skipped() > 0)
        throw std::runtime_error(file.string() + ": " + std::to_string(log.bytes_skipped()) +
                                 " bytes of it are no LCM log");
    if (stored.map.empty())
        throw std::runtime_error(file.string() + ": holds no map (nothing on " + messages::channels::kMap +
                                 ")");
    return stored;
}

/// What read(bytes) gives; `what` it is, for people.
template <typename Read>
auto decoded(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes, const char* what,
             const Read& read) {
    try {
        return read(bytes);
    } catch (const messages::OtherTypeError& error) {
        throw std::runtime_error(
            file.string() + ": its " + what +
            " is in the format of another planemap, which this one does not read: " + error.what());
    } catch (const messages::MessageError& error) {
        throw std::runtime_error(file.string() + ": its " + what + " is corrupt: " + error.what());
    }
}

}  // namespace

std::string plane_map_log(const PlaneMap& map, const SeenSpace& seen) {
    std::string log =
        event_of(0, map.utime, messages::channels::kMap, messages::to_bytes(messages::to_message(map, 0)));
    if (!seen.empty())
        log += event_of(1, map.utime, messages::channels::kSeenSpace,
                        messages::to_bytes(messages::to_message(seen, map.utime, 0)));
    return log;
}

void write_plane_map(const std::filesystem::path& file, const PlaneMap& map, const SeenSpace& seen) {
    write_file(file, plane_map_log(map, seen));
}

PlaneMap read_plane_map(const std::filesystem::path& file) {
    return decoded(file, read(file).map, "map", messages::plane_map_from);
}

SeenSpace read_seen_space(const std::filesystem::path& file) {
    const Stored stored = read(file);
    if (stored.seen.empty()) return {};
    return decoded(file, stored.seen, "seen space", [](const auto& bytes) {
        return messages::from_message(messages::decode<seen_space_t>(bytes));
    });
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
