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
    status_.received(static_cast<std::uint32_t>(received.seq));
    const std::size_t dropped = mapper_.dropped();
    mapper_.add(from_message(received));
    status_.dropped(static_cast<std::int64_t>(mapper_.dropped() - dropped));
}

void MapShell::on_trajectory(const RawMessage& message) {
    const KeyframeTrajectory trajectory = from_message(decode<trajectory_t>(message.bytes));
    {
        const ModuleStatus::Work work(status_);
        mapper_.update(trajectory);
    }
    publish();
}

void MapShell::publish() {
    bus_.publish(channels::kMap, to_message(mapper_.map(), seq_++));
    status_.published();
    status_.set_text(std::to_string(mapper_.map().planes.size()) + " planes" +
                     (mapper_.left_out_corners() ? ", too many meet to find all corners" : ""));
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
