// SPDX-License-Identifier: BSD-3-Clause
#include "map/told_up.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace planemap::map {

namespace {

constexpr double kGravity = 9.81;             // m/s2
constexpr std::size_t kRecent = 1024;         // readings: five seconds of a fast one
constexpr std::int64_t kAbout_us = 250000;    // readings so near to a keyframe are of its time: a hand shakes
                                              // faster than that
constexpr std::size_t kMostKeyframes = 4096;  // of which readings are kept

}  // namespace

void ToldUp::hear_mount(const Pose& body_from_camera) {
    const Eigen::Vector3d up_camera = body_from_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
    if (!up_camera.allFinite() || (mount_camera_ && up_camera.isApprox(*mount_camera_))) return;
    mount_camera_ = up_camera.normalized();
    ++revision_;
}

void ToldUp::hear(const Acceleration& reading) {
    const double g = reading.acceleration_camera.norm() / kGravity;
    if (!(g > 0.5 && g < 2)) return;
    recent_.push_back(reading);
    if (recent_.size() > kRecent) recent_.pop_front();
}

void ToldUp::came(int keyframe_id, std::int64_t utime) {
    if (read_camera_.contains(keyframe_id)) return;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Acceleration& reading : recent_)
        if (std::abs(reading.utime - utime) <= kAbout_us) sum += reading.acceleration_camera;
    if (sum.isZero()) return;
    read_camera_[keyframe_id] = sum.normalized().cast<float>();
    if (read_camera_.size() > kMostKeyframes) read_camera_.erase(read_camera_.begin());
    ++revision_;
}

Up ToldUp::find(const std::map<int, Pose>& poses, std::span<const MapPlane> planes,
                const GravityRules& rules) const {
    std::vector<Eigen::Vector3d> up_world;
    for (const auto& [id, up_camera] : read_camera_)
        if (const auto pose = poses.find(id); pose != poses.end())
            up_world.emplace_back(pose->second.linear() * up_camera.cast<double>());
    Up up;
    if (!up_world.empty()) up = up_as_told(up_world, planes, "the accelerometer", rules);
    if (up.direction || !mount_camera_) return up;
    up_world.clear();
    for (const auto& [id, pose] : poses) up_world.emplace_back(pose.linear() * *mount_camera_);
    Up mounted = up_as_told(up_world, planes, "camera.json's body_from_camera", rules);
    if (!up.why.empty()) mounted.why = up.why + "; " + mounted.why;
    return mounted;
}

}  // namespace planemap::map
