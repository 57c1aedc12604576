// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <stdexcept>

#include "map/map_file.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap {

namespace {
constexpr std::int64_t kWritePeriodUs = 5000000;
constexpr const char* kFile = "plane_map.lcmlog";
}  // namespace

MapShell::MapShell(Bus& bus, const MapShellOptions& options)
    : bus_(bus), output_(options.output), mapper_(options.map) {
    if (!options.start.empty()) mapper_.start_from(read_plane_map(options.start));
    tell_losses();
    if (!output_.empty()) {
        // A folder that cannot be written shows now, not after the run. An earlier map stays until there is
        // one.
        std::filesystem::create_directories(output_);
        if (!std::filesystem::exists(output_ / kFile)) write();
        if (::access(output_.c_str(), W_OK) != 0)
            throw std::runtime_error(output_.string() + ": is no folder that can be written to");
    }
    bus_.subscribe(channels::kKeyframe, status_.guard([this](const RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(channels::kTrajectory, status_.guard([this](const RawMessage& m) { on_trajectory(m); }),
                   16);
}

void MapShell::on_keyframe(const RawMessage& message) {
    const keyframe_t received = decode<keyframe_t>(message.bytes);
    status_.received(static_cast<std::uint32_t>(received.seq));
    mapper_.add(from_message(received));
    tell_losses();
}

void MapShell::on_trajectory(const RawMessage& message) {
    const KeyframeTrajectory trajectory = from_message(decode<trajectory_t>(message.bytes));
    {
        const ModuleStatus::Work work(status_);
        mapper_.update(trajectory);
    }
    tell_losses();
    publish();
}

/// What the mapper left out since the last time.
void MapShell::tell_losses() {
    const MapLosses now = mapper_.losses();
    const auto tell = [&](const char* what, std::size_t MapLosses::*count, bool is_whole_input = false) {
        const auto lost = static_cast<std::int64_t>(now.*count - told_.*count);
        status_.lost(what, lost);
        if (is_whole_input) status_.dropped(lost);
    };
    tell("regions that are none, or larger or farther than can be seen", &MapLosses::regions_refused);
    tell("regions after the 256th of a keyframe", &MapLosses::regions_too_many);
    tell("regions more than 100 km from the origin", &MapLosses::regions_too_far);
    tell("planes of the map to start from that are out of range", &MapLosses::planes_refused);
    tell("keyframe poses that are none or out of range", &MapLosses::poses_refused);
    tell("keyframes without a pose", &MapLosses::keyframes_unplaced, true);
    tell("keyframes that came again after they were folded", &MapLosses::keyframes_too_late, true);
    tell("keyframes with an id out of order", &MapLosses::keyframes_far_ahead, true);
    told_ = now;
}

void MapShell::publish() {
    bus_.publish(channels::kMap, to_message(mapper_.map(), seq_++));
    status_.published();
    status_.set_text(std::to_string(mapper_.map().planes.size()) + " planes");
    unwritten_ = true;
}

int MapShell::poll() {
    if (unwritten_ && !output_.empty() && now_us() - last_write_us_ >= kWritePeriodUs) write();
    return 100;
}

void MapShell::finish() {
    const std::size_t rebuilds = mapper_.rebuilds();
    mapper_.settle();
    if (mapper_.rebuilds() != rebuilds) publish();
    if (!output_.empty() && unwritten_) write();
}

void MapShell::write() {
    write_plane_map(output_ / kFile, mapper_.map());
    last_write_us_ = now_us();
    unwritten_ = false;
}

}  // namespace planemap
