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
constexpr std::int64_t kRetryPeriodUs = 1000000;  ///< after a write that failed
constexpr const char* kFile = "plane_map.lcmlog";
}  // namespace

MapShell::MapShell(Bus& bus, const MapShellOptions& options)
    : bus_(bus), output_(options.output), mapper_(options.map) {
    if (!options.start.empty()) mapper_.start_from(read_plane_map(options.start));
    tell_losses();
    status_.lost("fine edges of planes, since the map to start from is very large",
                 static_cast<std::int64_t>(mapper_.coarsened()));
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
    const Keyframe keyframe = from_message(received);
    if (!keyframe_guard_.admits(received.session, received.seq, received.utime, message.bytes)) return;
    mapper_.add(keyframe);
    tell_losses();
    tell();
}

void MapShell::on_trajectory(const RawMessage& message) {
    const trajectory_t received = decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = from_message(received);
    if (!trajectory_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
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
    tell("keyframes of another odometry, with an id that is taken", &MapLosses::keyframes_of_others, true);
    told_ = now;
}

void MapShell::publish() {
    bus_.publish(channels::kMap, to_message(mapper_.map(), seq_++));
    published_us_ = now_us();
    status_.published();
    unwritten_ = true;
    tell();
}

/// What there is, and what keeps it from the disk.
void MapShell::tell() {
    std::string text = std::to_string(mapper_.map().planes.size()) + " planes";
    if (mapper_.left_out_corners()) text += ", too many meet to find all corners";
    if (const std::size_t waiting = mapper_.waiting(); waiting > 0)
        text += ", " + std::to_string(waiting) + " keyframes wait for a pose";
    if (!write_error_.empty()) text += "; not written, trying every second: " + write_error_;
    status_.set_text(text);
}

int MapShell::poll() {
    if (published_us_ != 0 && now_us() - published_us_ >= kRepeat_us) {
        // For those who come late while the camera stands still: the same message again, which is no work.
        bus_.publish(channels::kMap, to_message(mapper_.map(), seq_ - 1));
        published_us_ = now_us();
    }
    const std::int64_t period = write_error_.empty() ? kWritePeriodUs : kRetryPeriodUs;
    if (unwritten_ && !output_.empty() && now_us() - last_write_us_ >= period) try_write();
    return 100;
}

void MapShell::finish() {
    const std::size_t rebuilds = mapper_.rebuilds();
    mapper_.settle();
    if (mapper_.rebuilds() != rebuilds) publish();
    if (!output_.empty() && unwritten_) try_write();
    if (!write_error_.empty()) throw std::runtime_error("the map could not be written: " + write_error_);
}

/// A disk that is full or gone ends nothing: the map is kept, said not to be written, and tried again.
void MapShell::try_write() {
    const bool failed_before = !write_error_.empty();
    try {
        write();
        write_error_.clear();
        if (failed_before) spdlog::info("{} is written again", (output_ / kFile).string());
    } catch (const std::exception& error) {
        write_error_ = error.what();
        last_write_us_ = now_us();
        if (!failed_before) spdlog::warn("{}; the map is kept, trying every second", write_error_);
    }
    tell();
}

void MapShell::write() {
    std::filesystem::create_directories(output_);  // somebody may have removed it
    write_plane_map(output_ / kFile, mapper_.map());
    last_write_us_ = now_us();
    unwritten_ = false;
}

}  // namespace planemap
