// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "map/earlier_map.hpp"
#include "map/map_file.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::map {

namespace {
constexpr std::int64_t kWritePeriodUs = 5000000;
constexpr std::int64_t kRetryPeriodUs = 1000000;  ///< after a write that failed
constexpr const char* kFile = "plane_map.lcmlog";

/// Whether an error says that a disk has no room or fails, which may pass, and not that a path is wrong.
bool is_disk_trouble(const std::error_code& error) {
    for (const int trouble : {ENOSPC, EDQUOT, EFBIG, EIO, ESTALE, ENOMEM})
        if (error.value() == trouble) return true;
    return false;
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::system_error(error, folder.string() + ": cannot be made");
}
}  // namespace

MapShell::MapShell(messages::Bus& bus, const MapShellOptions& options)
    : bus_(bus),
      output_(options.output),
      mapper_(options.map),
      watch_(status_, options.start.empty()
                          ? "the map is incomplete"
                          : "what they saw is in the map only as far as the map to start from held it") {
    if (!options.start.empty()) mapper_.start_from(read_plane_map(options.start));
    tell_losses();
    status_.lost("fine edges of planes, since the map to start from is very large",
                 static_cast<std::int64_t>(mapper_.coarsened()));
    if (!output_.empty()) try_output();
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(messages::channels::kTrajectory,
                   status_.guard([this](const messages::RawMessage& m) { on_trajectory(m); }), 16);
}

void MapShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    const Keyframe keyframe = messages::from_message(received);
    if (!keyframe_guard_.admits(received.session, received.seq, received.utime, message.bytes)) return;
    watch_.came(keyframe.id, keyframe.previous_id, keyframe.utime);
    mapper_.add(keyframe);
    tell_losses();
    tell();
}

void MapShell::on_trajectory(const messages::RawMessage& message) {
    const trajectory_t received = messages::decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = messages::from_message(received);
    if (!trajectory_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
    {
        const messages::ModuleStatus::Work work(status_);
        mapper_.update(trajectory);
    }
    watch_.named(trajectory, messages::now_us());
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
    tell("keyframes that came twice", &MapLosses::keyframes_again, true);
    tell("keyframes that came again after they were folded", &MapLosses::keyframes_too_late, true);
    tell("keyframes with an id out of order", &MapLosses::keyframes_far_ahead, true);
    tell("keyframes of another odometry, with an id that is taken", &MapLosses::keyframes_of_others, true);
    told_ = now;
}

void MapShell::publish() {
    bus_.publish(messages::channels::kMap, messages::to_message(mapper_.map(), seq_++, bus_.session()));
    published_us_ = messages::now_us();
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
    watch_.tell(messages::now_us());
    if (published_us_ != 0 && messages::now_us() - published_us_ >= messages::kRepeat_us) {
        // For those who come late while the camera stands still: the same message again, which is no work.
        bus_.publish(messages::channels::kMap, messages::to_message(mapper_.map(), seq_ - 1, bus_.session()));
        published_us_ = messages::now_us();
    }
    const std::int64_t period = write_error_.empty() ? kWritePeriodUs : kRetryPeriodUs;
    if (unwritten_ && !output_.empty() && messages::now_us() - last_write_us_ >= period) try_write();
    return 100;
}

void MapShell::finish() {
    const std::size_t rebuilds = mapper_.rebuilds();
    mapper_.settle();
    if (mapper_.rebuilds() != rebuilds) publish();
    if (!output_.empty() && unwritten_) try_write();
    if (!output_.empty() && !is_ours_ && write_error_.empty())
        spdlog::info("{}: no planes came, so the earlier map stays", (output_ / kFile).string());
    if (!write_error_.empty()) throw std::runtime_error("the map could not be written: " + write_error_);
    if (!output_.empty() && mapper_.map().planes.empty())
        throw std::runtime_error("nothing was mapped: no planes came");
}

/// A folder that cannot be one shows now, not after the run; a disk that is full now may have room later.
void MapShell::try_output() {
    const std::filesystem::path file = output_ / kFile;
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw std::runtime_error(file.string() + ": is a folder, where the map is to go");
    try {
        make_folder(output_);
        if (!std::filesystem::exists(file)) write();
    } catch (const std::system_error& error) {
        if (!is_disk_trouble(error.code())) throw;
        unwritten_ = true;
        write_failed(error.what());
        return;
    }
    if (::access(output_.c_str(), W_OK) != 0)
        throw std::runtime_error(output_.string() + ": is no folder that can be written to");
}

/// A disk that is full or gone ends nothing: the map is kept, said not to be written, and tried again.
void MapShell::try_write() {
    const bool failed_before = !write_error_.empty();
    try {
        write();
        write_error_.clear();
        if (failed_before) spdlog::info("{} is written again", (output_ / kFile).string());
    } catch (const std::exception& error) {
        write_failed(error.what());
    }
    tell();
}

void MapShell::write_failed(const std::string& why) {
    if (write_error_.empty()) spdlog::warn("{}; the map is kept, trying every second", why);
    write_error_ = why;
    last_write_us_ = messages::now_us();
    tell();
}

void MapShell::write() {
    make_folder(output_);  // somebody may have removed it
    if (make_way()) write_plane_map(output_ / kFile, mapper_.map());
    last_write_us_ = messages::now_us();
    unwritten_ = false;
}

/// Keeps what an earlier process left, under another name. False while there is nothing to write that is
/// worth as much.
bool MapShell::make_way() {
    const std::filesystem::path file = output_ / kFile;
    if (is_ours_ || !may_hold_planes(file)) return is_ours_ = true;
    if (mapper_.map().planes.empty()) return false;
    const KeptMap kept = keep_earlier_map(file);
    spdlog::info("the earlier map is kept as {}", kept.file.string());
    for (const std::filesystem::path& removed : kept.removed)
        spdlog::info("{}: removed, the newest of its kind are kept", removed.string());
    return is_ours_ = true;
}

}  // namespace planemap::map
