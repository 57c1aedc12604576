// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/surface_check.hpp"

#include <algorithm>
#include <cmath>

#include "benchmark/readings.hpp"
#include "core/geometry/angle.hpp"
#include "core/geometry/outline_frame.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "pipeline/given_poses.hpp"
#include "run/input.hpp"

namespace planemap::bench_map {

namespace {
constexpr std::size_t kLargest = 10;
constexpr double kReach_m = 0.03;
constexpr std::int64_t kEvery = 5;  // frames
}  // namespace

SurfaceChecker::SurfaceChecker(const PlaneMap& map) {
    for (const MapPlane& plane : map.planes) {
        Entry entry{plane.id,
                    plane.plane(),
                    plane.world_from_plane().inverse(Eigen::Isometry),
                    plane.outline.rings(),
                    {},
                    static_cast<double>(plane.area),
                    {}};
        entry.bounds = bounds(entry.outline);
        entries_.push_back(std::move(entry));
    }
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.area > b.area; });
    if (entries_.size() > kLargest) entries_.resize(kLargest);
}

void SurfaceChecker::add(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_color) {
    const Pose world_from_depth = world_from_color * camera.color_from_depth;
    benchmark::for_each_reading(depth, camera, [&](int u, int v, double z) {
        const Eigen::Vector3d p_world = world_from_depth * camera.depth.unproject(u, v, z);
        for (Entry& entry : entries_) {
            if (std::abs(entry.plane.signed_distance(p_world)) > kReach_m) continue;
            const Eigen::Vector3d p = entry.plane_from_world * p_world;
            if (!entry.bounds.contains(p.head<2>().eval())) continue;
            if (contains(entry.outline, p.head<2>())) entry.moments.add(p);
        }
    });
}

std::vector<SurfaceCheck> SurfaceChecker::checks() const {
    std::vector<SurfaceCheck> checks;
    for (const Entry& entry : entries_) {
        const PlaneFit fit = fit_plane(entry.moments, Eigen::Vector3d::UnitZ());
        if (!fit.valid) continue;
        // The box's middle is the origin of the plane's frame.
        checks.push_back({entry.id, entry.area, entry.moments.count,
                          degrees(angle_between(fit.plane.normal, Eigen::Vector3d::UnitZ())),
                          std::abs(fit.plane.d)});
    }
    return checks;
}

std::vector<SurfaceCheck> check_surfaces(const std::string& input_name, std::int64_t frames,
                                         const std::optional<CameraInfo>& camera, const PlaneMap& map,
                                         const Trajectory& truth) {
    SurfaceChecker checker(map);
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus, camera);
    std::int64_t count = 0;
    bus.subscribe(messages::channels::kFrame, [&](const messages::RawMessage& message) {
        if (count++ % kEvery != 0) return;
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
