// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_journal.hpp"

#include <spdlog/spdlog.h>

#include <iterator>
#include <map>
#include <utility>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::graph {

std::optional<GraphJournal::Came> GraphJournal::replay(messages::Complaints& complaints,
                                                       const std::function<bool(const keyframe_t&)>& take) {
    for (const std::string& complaint : journal_.complaints()) spdlog::warn("graph: {}", complaint);
    std::optional<Came> newest;
    journal_.replay([&](const messages::LogEvent& event) {
        try {
            keyframe_t received = messages::decode<keyframe_t>(event.bytes);
            if (take(received)) newest = Came{std::move(received), event.bytes};
        } catch (const messages::MessageError& error) {
            complaints.add(file().string() + ": a keyframe left out: " + error.what());
        }
    });
    return newest;
}

void GraphJournal::add(std::span<const std::uint8_t> keyframe) {
    journal_.add(messages::channels::kKeyframe, keyframe);
}

void GraphJournal::tend(const KeyframeTrajectory& trajectory, messages::ModuleStatus& status) {
    if (journal_.is_due_to_compact()) compact(trajectory);
    if (const auto news = journal_.news()) status.remark("journal", *news);
}

void GraphJournal::compact(const KeyframeTrajectory& trajectory) {
    std::map<int, Pose> poses;
    for (const KeyframePose& keyframe : trajectory.keyframes) poses[keyframe.id] = keyframe.world_from_camera;
    journal_.compact([&](messages::LogEvent& event) {
        keyframe_t message = messages::decode<keyframe_t>(event.bytes);
        const auto here = poses.find(message.id);
        if (here == poses.end()) return false;
        if (message.previous_id < 0 || poses.contains(message.previous_id) || here == poses.begin())
            return true;
        const auto before = std::prev(here);
        Keyframe keyframe = messages::from_message(message);
        keyframe.previous_id = before->first;
        keyframe.previous_from_camera = before->second.inverse(Eigen::Isometry) * here->second;
        event.bytes = messages::to_bytes(messages::to_message(keyframe, message.seq, message.session));
        return true;
    });
}

}  // namespace planemap::graph
