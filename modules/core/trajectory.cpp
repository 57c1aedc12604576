// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "core/files.hpp"
#include "core/stamp.hpp"
#include "core/text_file.hpp"

namespace planemap {

Trajectory read_trajectory(const std::filesystem::path& file) {
    std::istringstream in(read_text_file(file));
    Trajectory trajectory;
    StampColumn stamps;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const auto start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        double v[8];
        std::string stamp;
        for (double& value : v) {
            std::string text;
            fields >> text;
            if (stamp.empty()) stamp = text;
            char* end = nullptr;
            value = std::strtod(text.c_str(), &end);
            if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
                throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                                         ": expected eight finite numbers: timestamp tx ty tz qx qy qz qw");
            }
        }
        const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
        if (!(q.norm() > 1e-3 && q.norm() < 1e3)) {
            throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                                     ": the quaternion is not of unit length");
        }
        try {
            trajectory.push_back({stamps.read(stamp), make_pose({v[1], v[2], v[3]}, q)});
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + error.what());
        }
    }
    std::stable_sort(trajectory.begin(), trajectory.end(),
                     [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return trajectory;
}

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

}  // namespace planemap
