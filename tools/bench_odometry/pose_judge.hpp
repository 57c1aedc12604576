// SPDX-License-Identifier: BSD-3-Clause
// Whether what odometry says of frames is true, as far as it says that it is.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::bench_odometry {

/// One frame: what was said, and where the camera was.
struct ToldFrame {
    OdometryEstimate estimate;
    std::optional<Pose> truth;  ///< world_from_camera at the moment of its pose; nothing: not known
};

/// A keyframe as its message tells of it.
struct ToldKeyframe {
    int id = -1;
    int previous_id = -1;   ///< -1: its part begins with it
    std::size_t frame = 0;  ///< the frame that it was made of
    Pose odom_from_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< of the edge from previous_id, as Keyframe::covariance
};

struct JudgeLimits {
    double wrong_m = 0.10, wrong_deg = 5;       ///< an error beyond is no small one
    double unknown_m = 0.20, unknown_deg = 10;  ///< a standard deviation beyond is no pose
    double sigmas = 3;                          ///< an error within is one that was admitted
};

/// A standard deviation in the worst direction.
struct Spread {
    double metres = 0, degrees = 0;
};
Spread spread_of(const Matrix6d& covariance);
bool is_unknown(const Matrix6d& covariance, const JudgeLimits& limits = {});

/// Whether an error is within so many standard deviations: its translation and its rotation, each as three
/// values together (Mahalanobis distance).
bool is_within(const Twist& error, const Matrix6d& covariance, double sigmas);

/// The error of `estimate` in the estimated camera's own frame: estimate = truth moved by it.
Twist pose_error(const Pose& estimate, const Pose& truth);

/// Normalised estimation error squared, e' P^-1 e; nothing where the covariance has no inverse. Of six values
/// that are honest, 95 % are below kNees95.
std::optional<double> nees_of(const Twist& error, const Matrix6d& covariance);
inline constexpr double kNees95 = 12.59;

struct Judgement {
    enum class Verdict {
        kUnknown,   ///< there is no truth, or nothing to hold the pose against yet
        kNoPose,    ///< lost, or its standard deviation is over unknown_m or unknown_deg
        kRight,     ///< within wrong_m and wrong_deg
        kAdmitted,  ///< beyond, but said to be degenerate or stale, and within `sigmas`
        kWrong,     ///< beyond, and not said
    };
    Verdict verdict = Verdict::kUnknown;
    double metres = 0, degrees = 0;  ///< error; 0 where there is none
    int part = -1;                   ///< the keyframe that its part begins with; -1: no pose
};

/// Holds frames against each other. Keyframes that edges join are one part. An edge whose standard deviation
/// is over unknown_m or unknown_deg joins nothing: what comes after it is a part of its own, of which no
/// relation to the one before is claimed.
///
/// Within a part a frame is held against the reference: the part's last tracked frame before `first`, or, if
/// it begins later, its first tracked one; the judged value is the pose of the camera in the reference's
/// camera, by odom_from_camera. Its covariance is that of both frames against their keyframes and of all
/// edges between these. A frame counts as degenerate if it, or the frame of a keyframe on the way, is.
class PoseJudge {
  public:
    /// `first` is the first frame that is disturbed. Keyframes in order of their ids, each after those
    /// before.
    PoseJudge(std::span<const ToldFrame> frames, std::span<const ToldKeyframe> keyframes, std::size_t first,
              const JudgeLimits& limits = {});

    Judgement judge(std::size_t frame) const;
    /// Parts that began at or after `first`.
    int parts_begun() const;

  private:
    bool joins(const ToldKeyframe& keyframe) const;
    int part_of(int id) const;
    Matrix6d covariance(const OdometryEstimate& from, const OdometryEstimate& to, bool& is_marked) const;

    std::span<const ToldFrame> frames_;
    std::size_t first_;
    JudgeLimits limits_;
    std::map<int, ToldKeyframe> keyframes_;
    std::map<int, std::size_t> references_;  ///< by part
};

}  // namespace planemap::bench_odometry
