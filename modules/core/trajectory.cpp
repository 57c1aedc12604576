// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/components.hpp"
#include "core/files.hpp"

namespace planemap {

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
    std::string text = "# timestamp tx ty tz qx qy qz qw (seconds, world_from_camera, metres)\n";
    for (const StampedPose& pose : trajectory) {
        const Eigen::Vector3d t = pose.world_from_camera.translation();
        Eigen::Quaterniond q(pose.world_from_camera.linear());
        q.normalize();
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        const std::int64_t seconds = pose.utime / 1000000, micros = std::abs(pose.utime % 1000000);
        char line[4096];  // seven values of at most 318 characters each
        std::snprintf(line, sizeof(line), "%s%lld.%06lld %.7f %.7f %.7f %.7f %.7f %.7f %.7f\n",
                      pose.utime < 0 && seconds == 0 ? "-" : "", static_cast<long long>(seconds),
                      static_cast<long long>(micros), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
        text += line;
    }
    write_file(file, text);
}

void write_trajectories(const std::filesystem::path& folder, const std::vector<Trajectory>& trajectories) {
    for (std::size_t number = 1; number <= kMostComponentFiles; ++number) {
        const std::filesystem::path file = folder / component_file("trajectory.txt", number);
        std::error_code ignored;
        if (number <= trajectories.size())
            write_trajectory(file, trajectories[number - 1]);
        else if (number > 1)
            std::filesystem::remove(file, ignored);
    }
}

std::optional<Pose> pose_at(const Trajectory& trajectory, std::int64_t utime, std::int64_t max_gap_us) {
    const auto after =
        std::lower_bound(trajectory.begin(), trajectory.end(), utime,
                         [](const StampedPose& pose, std::int64_t t) { return pose.utime < t; });
    if (after == trajectory.end()) return std::nullopt;
    if (after->utime == utime) return after->world_from_camera;
    if (after == trajectory.begin()) return std::nullopt;
    const StampedPose &a = *(after - 1), &b = *after;
    if (b.utime - a.utime > max_gap_us) return std::nullopt;
    return interpolate(a.world_from_camera, b.world_from_camera,
                       static_cast<double>(utime - a.utime) / static_cast<double>(b.utime - a.utime));
}

}  // namespace planemap
