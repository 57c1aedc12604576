// SPDX-License-Identifier: BSD-3-Clause
#include "run/doubts.hpp"

#include <algorithm>

#include "core/components.hpp"
#include "evaluate/evaluation.hpp"
#include "run/report_text.hpp"

namespace planemap {

void DepthCount::add(const DepthImage& depth, const CameraInfo& camera) {
    constexpr int kStride = 8;
    const std::int64_t before = readings;
    for (int v = kStride / 2; v < depth.height; v += kStride) {
        for (int u = kStride / 2; u < depth.width; u += kStride) {
            const std::uint16_t raw = depth(u, v);
            if (!is_valid_depth(raw)) continue;
            ++readings;
            const double z = camera.metres(raw);
            outside += z < camera.depth_min_m || z > camera.depth_max_m;
        }
    }
    ++images;
    empty += readings == before;
}

std::vector<std::string> doubts_of_depth(const DepthCount& count) {
    constexpr double kMostlyOutside = 0.6;
    std::vector<std::string> lines;
    if (count.empty > 0 && count.empty < count.images) {  // of none with a reading there is an error
        lines.push_back(std::to_string(count.empty) + " of " + std::to_string(count.images) +
                        " depth images hold no reading");
    }
    const double share =
        count.readings > 0 ? static_cast<double>(count.outside) / static_cast<double>(count.readings) : 0.0;
    if (share > kMostlyOutside) {
        lines.push_back(
            format("%.0f %% of the depth readings are out of the sensor's range and not used", 100 * share) +
            ": are depth_units_per_metre and depth_range_m in camera.json right?");
    }
    return lines;
}

std::string doubt_of_given_poses(const Trajectory& given, const std::vector<OdometryEstimate>& seen) {
    constexpr double kOther_m = 0.1, kOther_deg = 5;  // medians: odometry itself is off by far less
    Trajectory tracked;
    for (const OdometryEstimate& estimate : seen)
        if (is_placed(estimate)) tracked.push_back({estimate.pose_utime, estimate.odom_from_camera});
    std::stable_sort(tracked.begin(), tracked.end(),
                     [](const StampedPose& a, const StampedPose& b) { return a.utime < b.utime; });
    const auto same = [](const StampedPose& a, const StampedPose& b) { return a.utime == b.utime; };
    tracked.erase(std::unique(tracked.begin(), tracked.end(), same), tracked.end());
    if (tracked.empty() || given.empty()) return {};
    const Evaluation evaluation = evaluate(given, tracked, {});
    if (!evaluation.rpe_1s) return {};
    const double metres = evaluation.rpe_1s->metres.median, degrees = evaluation.rpe_1s->degrees.median;
    if (!(metres > kOther_m || degrees > kOther_deg)) return {};
    return format("the given poses move otherwise than the camera was seen to: by %.2f m", metres) +
           format(" and %.1f deg over a second (median)", degrees) +
           "; are they this recording's, of the colour camera in the world, in metres, their quaternions x y "
           "z w?";
}

std::string doubt_of_start(const PlaneMap& start, const PlaneMap& map) {
    if (start.planes.empty()) return {};
    const bool is_seen_again =
        std::any_of(start.planes.begin(), start.planes.end(), [&](const MapPlane& old) {
            const MapPlane* now = map.find(old.id);
            return now == nullptr || now->keyframes > old.keyframes || old.keyframes == INT16_MAX;
        });
    if (is_seen_again) return {};
    return "none of the " + std::to_string(start.planes.size()) +
           " planes of the map that was started from was seen again: is it of this place, and in this run's "
           "world frame?";
}

}  // namespace planemap
