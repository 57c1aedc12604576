// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/surfaces.hpp"

#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "pipeline/given_poses.hpp"
#include "run/input.hpp"

namespace planemap::bench_map {

namespace {
constexpr std::int64_t kStepFrames = 5;
}  // namespace

std::vector<evaluation::SurfaceCheck> check_surfaces(const std::string& input_name, std::int64_t frames,
                                                     const std::optional<CameraInfo>& camera,
                                                     const PlaneMap& map, const Trajectory& truth) {
    evaluation::SurfaceChecker checker(map);
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus, camera);
    std::int64_t count = 0;
    bus.subscribe(messages::channels::kFrame, [&](const messages::RawMessage& message) {
        if (count++ % kStepFrames != 0) return;
        const auto frame = decoder.decode(message);
        if (!frame) return;
        const std::optional<Pose> pose = pipeline::given_pose(truth, frame->utime());
        if (pose) checker.add(frame->depth(), frame->camera(), *pose);
    });
    const std::unique_ptr<Input> input = open_input(input_name, bus, {.camera = camera});
    feed_all(*input, frames, [&](std::int64_t) { bus.drain(); });
    return checker.checks();
}

}  // namespace planemap::bench_map
