// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_journal.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <utility>

#include "map/stored_keyframe.hpp"
#include "messages/bus.hpp"
#include "messages/channels.hpp"

namespace planemap::map {

namespace {

constexpr std::int64_t kSavePeriodUs = 1000000;
/// Of each keyframe: as many as the map keeps.
constexpr auto kLooksKept = static_cast<int>(StoredKeyframe::kMostLater);
constexpr const char* kEarlierIds = "PLANEMAP_REGION_PLANES";  ///< in journals before PLANEMAP_SURFACES

/// The message of an event; nothing for a damaged one, which replay() has complained of.
template <typename T>
std::optional<T> whole(const messages::LogEvent& event) {
    try {
        return messages::decode<T>(event.bytes);
    } catch (const messages::MessageError&) {
        return std::nullopt;
    }
}

}  // namespace

MapJournal::Earlier MapJournal::replay(messages::Complaints& complaints,
                                       const std::function<void(const keyframe_t&)>& on_keyframe,
                                       const std::function<void(const look_t&)>& on_look) {
    for (const std::string& complaint : journal_.complaints()) spdlog::warn("map: {}", complaint);
    Earlier earlier;
    journal_.replay([&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kTrajectory) {
            earlier.trajectory = event.bytes;
        } else if (event.channel == kEarlierIds) {
            complaints.add(file() + ": ids of planes in an earlier format: planes get new ones");
        } else {
            try {
                if (event.channel == messages::channels::kSurfaces) {
                    earlier.surfaces = messages::from_message(messages::decode<surfaces_t>(event.bytes));
                    return;
                }
                if (event.channel == messages::channels::kLook)
                    return on_look(messages::decode<look_t>(event.bytes));
                keyframe_t keyframe = messages::decode<keyframe_t>(event.bytes);
                on_keyframe(keyframe);
                earlier.newest = std::move(keyframe);
                earlier.newest_bytes = event.bytes;
            } catch (const messages::MessageError& error) {
                complaints.add(file() + ": a message left out: " + error.what());
            }
        }
    });
    return earlier;
}

void MapJournal::save(const std::function<std::vector<std::uint8_t>()>& surfaces) {
    if (trajectory_.empty()) return;
    journal_.add(messages::channels::kTrajectory, trajectory_);
    journal_.add(messages::channels::kSurfaces, surfaces());
    trajectory_.clear();
    saved_us_ = messages::now_us();
}

void MapJournal::tend(const std::function<std::vector<std::uint8_t>()>& surfaces,
                      const std::function<bool(int)>& has_keyframe) {
    const bool is_large = journal_.is_due_to_compact();
    if (is_large || messages::now_us() - saved_us_ >= kSavePeriodUs) save(surfaces);
    if (is_large) compact(has_keyframe);
}

void MapJournal::compact(const std::function<bool(int)>& has_keyframe) {
    std::int64_t last = -1;     // of the poses, and of the ids, only the last ones count
    std::map<int, int> newest;  // number of the last look of each keyframe
    journal_.replay([&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kSurfaces) last = event.number;
        if (event.channel != messages::channels::kLook) return;
        if (const auto look = whole<look_t>(event))
            newest[look->keyframe_id] = std::max(newest[look->keyframe_id], look->number);
    });
    journal_.compact([&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kKeyframe) {
            const auto keyframe = whole<keyframe_t>(event);
            return keyframe && has_keyframe(keyframe->id);
        }
        if (event.channel == messages::channels::kLook) {
            const auto look = whole<look_t>(event);
            return look && has_keyframe(look->keyframe_id) &&
                   (look->number == 0 || newest[look->keyframe_id] - look->number < kLooksKept);
        }
        return event.number >= last - 1;
    });
}

}  // namespace planemap::map
