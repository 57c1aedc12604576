// SPDX-License-Identifier: BSD-3-Clause
// The recent keyframes that frames are tracked against.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/region.hpp"
#include "odometry/flow.hpp"
#include "odometry/planar_patches.hpp"

namespace planemap::odometry {

/// A corner of a keyframe with its 3D point.
struct TrackPoint {
    cv::Point2f pixel;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< keyframe camera frame at its depth time, metres
    Eigen::Vector3d per_readout = Eigen::Vector3d::Zero();  ///< see PointTerm::point_per_readout
    double inverse_depth_sigma = 0;                         ///< 1/m
    int region = -1;                                        ///< region it was regularised to; -1: none
};

/// A keyframe that frames are tracked against.
struct LocalKeyframe {
    int id = -1;
    std::int64_t utime = 0;  ///< of its depth image, microseconds
    Pose odom_from_keyframe = Pose::Identity();
    std::vector<TrackPoint> points;
    FlowPyramid pyramid;  ///< with derivatives
    PlanarPatches patches;
    std::vector<PlanarRegion> regions;
    Twist velocity = Twist::Zero();  ///< of the camera then, see MotionFilter::velocity()

    std::vector<cv::Point2f> pixels() const;  ///< of the points
};

/// A bounded list of keyframes in order of use, the newest last; one of them is tracked against.
class LocalKeyframes {
  public:
    /// Keeps `others` keyframes besides the newest.
    explicit LocalKeyframes(int others) : others_(others) {}

    bool empty() const { return keyframes_.empty(); }
    void clear() { keyframes_.clear(); }
    /// Adds a keyframe, which is then the current one; the one not used for longest goes when there are too
    /// many.
    void add(LocalKeyframe keyframe);

    /// The one tracked against. Precondition: not empty.
    const LocalKeyframe& current() const { return keyframes_[current_]; }
    /// The one with an id, or nullptr.
    const LocalKeyframe* find(int id) const;
    /// Tracks against a keyframe again; one that is not here any more changes nothing.
    void make_current(int id);
    /// The same, and makes it the newest, so that it stays.
    void renew(int id);

    const std::vector<LocalKeyframe>& all() const { return keyframes_; }

  private:
    int others_;
    std::vector<LocalKeyframe> keyframes_;
    std::size_t current_ = 0;
};

}  // namespace planemap::odometry
