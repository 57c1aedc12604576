// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>

#include "core/components.hpp"
#include "map/map_file.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::map {

MapShell::MapShell(messages::Bus& bus, const MapShellOptions& options)
    : bus_(bus),
      needs_planes_(options.needs_planes),
      tells_surfaces_(options.map.unites_surfaces()),
      maps_(options.map),
      output_(options.output),
      watch_(status_, options.start.empty()
                          ? "the map is incomplete"
                          : "what they saw is in the map only as far as the map to start from held it") {
    if (!options.start.empty())
        maps_.start_from(read_plane_map(options.start), read_seen_space(options.start));
    tell_losses();
    status_.lost("fine edges of planes, since the map to start from is very large",
                 static_cast<std::int64_t>(mapper().work().coarsened));
    if (!options.journal.empty()) {
        journal_ = std::make_unique<MapJournal>(options.journal);
        resume();
    }
    output_.open(maps_);
    if (!output_.error().empty()) tell();
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(messages::channels::kLook,
                   status_.guard([this](const messages::RawMessage& m) { on_look(m); }), 256);
    bus_.subscribe(messages::channels::kTrajectory,
                   status_.guard([this](const messages::RawMessage& m) { on_trajectory(m); }), 16);
    bus_.subscribe(messages::channels::kCameraInfo,
                   status_.guard([this](const messages::RawMessage& m) { on_camera(m); }), 4);
    bus_.subscribe(messages::channels::kAcceleration,
                   status_.guard([this](const messages::RawMessage& m) { on_acceleration(m); }), 1024);
}

void MapShell::on_acceleration(const messages::RawMessage& message) {
    maps_.hear(messages::from_message(messages::decode<acceleration_t>(message.bytes)));
}

void MapShell::hear(const CameraInfo& camera) {
    if (camera.body_from_camera) maps_.hear_mount(*camera.body_from_camera);
}

void MapShell::on_camera(const messages::RawMessage& message) {
    hear(messages::from_message(messages::decode<camera_info_t>(message.bytes)));
}

void MapShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    const Keyframe keyframe = messages::from_message(received);
    // Odometry sends the last ones again when a module was started again.
    if (received.session != 0 && received.session == keyframes_of_ && watch_.has(keyframe.id))
        return status_.count_loss("keyframes that came twice");
    if (!keyframe_guard_.admits(received.session, received.seq, received.utime, message.bytes)) return;
    keyframes_of_ = received.session;
    watch_.came(keyframe.id, keyframe.previous_id, keyframe.utime);
    maps_.add(keyframe);
    if (journal_) journal_->add(message.channel, message.bytes);
    tell_losses();
    tell();
}

void MapShell::on_look(const messages::RawMessage& message) {
    const look_t received = messages::decode<look_t>(message.bytes);
    const Look look = messages::from_message(received);
    if (received.session != keyframes_of_) return status_.count_loss("looks of another odometry");
    const bool has_changed = [&] {
        const messages::ModuleStatus::Work work(status_);
        return maps_.add(look);
    }();
    if (journal_) journal_->add(message.channel, message.bytes);
    tell_losses();
    if (has_changed) publish();
}

void MapShell::on_trajectory(const messages::RawMessage& message) {
    const trajectory_t received = messages::decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = messages::from_message(received);
    if (!trajectory_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
    {
        const messages::ModuleStatus::Work work(status_);
        maps_.update(trajectory);
    }
    watch_.named(trajectory, messages::now_us());
    if (journal_) journal_->keep_poses(message.bytes);
    tell_losses();
    publish();
}

/// Takes keyframes, their poses and the planes' ids from the process before.
void MapShell::resume() {
    const auto on_keyframe = [&](const keyframe_t& received) {
        const Keyframe keyframe = messages::from_message(received);
        watch_.came(keyframe.id, keyframe.previous_id, keyframe.utime);
        maps_.add(keyframe);
    };
    const auto on_look = [&](const look_t& received) { maps_.add(messages::from_message(received)); };
    const MapJournal::Earlier earlier = journal_->replay(bus_.complaints(), on_keyframe, on_look);
    if (earlier.newest) {
        const keyframe_t& newest = *earlier.newest;
        keyframe_guard_.resume(newest.session, newest.seq, newest.utime, earlier.newest_bytes);
        keyframes_of_ = newest.session;
    }
    if (earlier.trajectory.empty()) return;
    const trajectory_t last = messages::decode<trajectory_t>(earlier.trajectory);
    trajectory_guard_.resume(last.session, last.seq, std::nullopt, earlier.trajectory);
    const KeyframeTrajectory poses = messages::from_message(last);
    maps_.update(poses);
    maps_.restore_ids(earlier.surfaces);
    watch_.named(poses, messages::now_us());
    output_.claim();
    tell_losses();
    spdlog::info("map: goes on with {} planes of {} keyframes of {}", mapper().map().planes.size(),
                 maps_.keyframes(), journal_->file());
    publish();
}

std::vector<std::uint8_t> MapShell::surfaces_message() const {
    return messages::to_bytes(messages::to_message(maps_.surfaces(), surfaces_seq_, bus_.session()));
}

/// What the mapper left out since the last time.
void MapShell::tell_losses() {
    const MapLosses now = maps_.losses();
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
    tell("looks of keyframes that are not in the map", &MapLosses::looks_refused);
    tell("keyframes of another odometry, with an id that is taken", &MapLosses::keyframes_of_others, true);
    told_ = now;
}

void MapShell::publish() {
    publish_maps(seq_++);
    published_us_ = messages::now_us();
    publish_surfaces();
    // How old a map is, is told by the keyframe that is new in it.
    if (const std::int64_t utime = mapper().map().utime; utime > newest_utime_) {
        newest_utime_ = utime;
        status_.published(utime, published_us_);
    } else {
        status_.published();
    }
    output_.change();
    tell();
}

/// Of the component with the most keyframes on its own channel, of others beside it.
void MapShell::publish_maps(std::int32_t seq) {
    const std::vector<const PlaneMapper*> maps = maps_.all();
    for (std::size_t i = 0; i < std::min(maps.size(), kMostComponentFiles); ++i)
        bus_.publish(i == 0 ? messages::channels::kMap : messages::channels::kOtherMaps,
                     messages::to_message(maps[i]->map(), seq, bus_.session()));
}

/// After a rebuild: only that tells planes that were two and are one.
void MapShell::publish_surfaces() {
    if (!tells_surfaces_ || maps_.rebuilds() == told_rebuilds_) return;
    told_rebuilds_ = maps_.rebuilds();
    bus_.publish(messages::channels::kSurfaces,
                 messages::to_message(maps_.surfaces(), surfaces_seq_++, bus_.session()));
}

bool MapShell::is_up_missing() const {
    return mapper().map().up.isZero() && !mapper().map().planes.empty();
}

/// What there is, and what keeps it from the disk.
void MapShell::tell() {
    std::string text = std::to_string(mapper().map().planes.size()) + " planes";
    if (const std::size_t all = maps_.all().size(); all > 1)
        text += " of the largest of " + std::to_string(all) + " components that do not hang together";
    if (mapper().left_out_corners()) text += ", too many meet to find all corners";
    if (const std::size_t waiting = maps_.waiting(); waiting > 0)
        text += ", " + std::to_string(waiting) + " keyframes wait for a pose";
    if (!output_.error().empty()) text += "; not written, trying every second: " + output_.error();
    if (is_up_missing()) text += "; up is not known";
    status_.set_text(text);
}

int MapShell::poll() {
    if (journal_) {
        journal_->tend([this] { return surfaces_message(); },
                       [this](int id) { return maps_.has_keyframe(id); });
        if (const auto news = journal_->news()) status_.remark("journal", *news);
    }
    watch_.tell(messages::now_us());
    if (published_us_ != 0 && messages::now_us() - published_us_ >= messages::kRepeat_us) {
        // For those who come late while the camera stands still: the same message again, which is no work.
        publish_maps(seq_ - 1);
        published_us_ = messages::now_us();
    }
    if (output_.poll(maps_)) tell();
    return 100;
}

void MapShell::settle() {
    const std::size_t rebuilds = maps_.rebuilds();
    maps_.settle();
    if (maps_.rebuilds() != rebuilds) publish();
}

void MapShell::finish() {
    settle();
    if (is_up_missing())
        status_.remark("up", "up is not known, so no plane has a label: " + mapper().why_up());
    if (journal_) journal_->save([this] { return surfaces_message(); });
    if (output_.finish(maps_)) tell();
    if (output_.leaves_earlier())
        spdlog::info("{}: no planes came, so the earlier map stays", output_.file().string());
    if (!output_.error().empty())
        throw std::runtime_error("the map could not be written: " + output_.error());
    if (needs_planes_ && mapper().map().planes.empty())
        throw std::runtime_error("nothing was mapped: no planes came");
}

}  // namespace planemap::map
