// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

#include <spdlog/spdlog.h>

#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"

namespace planemap {

namespace {
constexpr std::int64_t kWritePeriodUs = 5000000;
}

MapShell::MapShell(Bus& bus, const MapShellOptions& options)
    : bus_(bus), output_(options.output), mapper_(options.map) {
    if (!output_.empty()) {
        std::filesystem::create_directories(output_);
        write();  // a folder that cannot be written shows now, not after the run
    }
    bus_.subscribe(channels::kKeyframe, status_.guard([this](const RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(channels::kTrajectory, status_.guard([this](const RawMessage& m) { on_trajectory(m); }),
                   16);
}

void MapShell::on_keyframe(const RawMessage& message) {
    const keyframe_t received = decode<keyframe_t>(message.bytes);
    status_.received(static_cast<std::uint32_t>(received.seq));
    mapper_.add(from_message(received));
}

void MapShell::on_trajectory(const RawMessage& message) {
    const KeyframeTrajectory trajectory = from_message(decode<trajectory_t>(message.bytes));
    {
        const ModuleStatus::Work work(status_);
        mapper_.update(trajectory);
    }
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
    if (!output_.empty()) write();
}

void MapShell::write() {
    write_file(output_ / "plane_map.lcmlog", plane_map_log(mapper_.map()));
    last_write_us_ = now_us();
    unwritten_ = false;
}

std::string plane_map_log(const PlaneMap& map) {
    const plane_map_t message = to_message(map, 0);
    LogEvent event;
    event.utime = map.utime;
    event.channel = channels::kMap;
    event.bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(event.bytes.data(), 0, message.getEncodedSize());
    return encode_event(event);
}

}  // namespace planemap
