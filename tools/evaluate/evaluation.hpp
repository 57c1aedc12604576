// SPDX-License-Identifier: BSD-3-Clause
// Trajectory errors as the TUM RGB-D benchmark defines them: Sturm, Engelhard, Endres, Burgard, Cremers: A
// Benchmark for the Evaluation of RGB-D SLAM Systems, IROS 2012, and its tools associate.py, evaluate_ate.py
// and evaluate_rpe.py. Three differences, all on purpose: stamps are whole microseconds, so a difference that
// equals a limit does not depend on rounding; no pair is left out at random (the tools' --max_pairs 0); and
// relative errors take no pose of the truth for one that is of another moment (see relative_error()).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/trajectory.hpp"
#include "evaluate/statistics.hpp"

namespace planemap {

struct EvaluationOptions {
    /// Poses whose stamps differ by less than this may be matched for the ATE, seconds; above 0.
    double max_difference_s = 0.02;
    /// Added to the estimate's stamps before they are compared with the truth's, seconds.
    double offset_s = 0.0;
    /// Factor on the estimate's translations; above 0. With AbsoluteError::scale here, alignment is over
    /// Sim(3).
    double scale = 1.0;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Index into the truth, index into the estimate.
using PosePair = std::pair<std::size_t, std::size_t>;

/// Matches of two trajectories by time, in order of the truth's time: of all pairs closer than
/// max_difference_s the closest is taken first, and each pose at most once (associate.py).
std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                const EvaluationOptions& options);

/// Absolute trajectory error: distances between positions after the estimate was laid on the truth.
struct AbsoluteError {
    Statistics metres;
    /// The rigid motion that lays the (scaled) estimate on the truth with least squares.
    Pose truth_from_estimate = Pose::Identity();
    /// Least squares factor that the estimate still has to be multiplied by: 1 for a true scale, below 1 for
    /// an estimate that is too large. NaN when the matched estimate does not move.
    double scale = 1.0;
};

/// ATE over matched poses by Horn's closed form, rotation and translation only (evaluate_ate.py: align).
/// Nothing for fewer than three pairs. Fewer than three distinct positions, or positions on a line, leave
/// rotations free that do not change the error.
std::optional<AbsoluteError> absolute_error(const Trajectory& truth, const Trajectory& estimate,
                                            const std::vector<PosePair>& pairs, double scale = 1.0);

/// What the distance between the two poses of a relative error is counted in: time, path length or rotation
/// of the estimate, or the estimate's poses.
enum class DeltaUnit { seconds, metres, radians, degrees, frames };

struct Delta {
    double value = 1.0;
    DeltaUnit unit = DeltaUnit::seconds;
};

/// Relative pose error: how far the estimate's motion over a delta is from the truth's over the same time.
struct RelativeError {
    Statistics metres;
    Statistics degrees;
    std::size_t left_out = 0;  ///< pairs of the estimate for which the truth has no poses
};

/// RPE over a fixed delta (evaluate_rpe.py --fixed_delta). Each pose of the estimate is paired with the one
/// nearest to delta further on, unless that is the last. The truth's pose is the nearest in time if that is
/// within 5 ms, else it is interpolated between two poses at most 0.1 s apart; where the truth is sparser the
/// pair is left out: the tool's nearest pose, which may be twice the truth's interval away, would give the
/// camera's own motion for an error. With relative motion r = inverse(second) * first, the error is
/// inverse(r_estimate) * r_truth. Nothing for fewer than two pairs: a trajectory shorter than delta, a sparse
/// truth, or no overlap in time.
std::optional<RelativeError> relative_error(const Trajectory& truth, const Trajectory& estimate,
                                            const Delta& delta, const EvaluationOptions& options);

/// Why relative_error() gives nothing, in words. Precondition: it does.
std::string why_no_relative_error(const Trajectory& truth, const Trajectory& estimate, const Delta& delta);

/// Length of the truth's path from the first matched pose to the last, metres; 0 without pairs.
double matched_path_length(const Trajectory& truth, const std::vector<PosePair>& pairs);

/// How far the truth's matched positions lie from their middle, RMS, metres; 0 without pairs.
double matched_extent(const Trajectory& truth, const std::vector<PosePair>& pairs);

/// The trajectory with one pose a stamp: of several the last, as the tools' dictionaries keep it. Sorted
/// input.
Trajectory without_repeated_stamps(const Trajectory& trajectory);

/// All figures of one estimate.
struct Evaluation {
    std::size_t truth_poses = 0, estimate_poses = 0, pairs = 0;
    /// pairs / estimate_poses: the share of the estimate that the truth can judge.
    double matched_share = 0.0;
    double path_length_m = 0.0;
    double extent_m = 0.0;  ///< of the truth's matched poses: RMS distance from their middle
    std::optional<AbsoluteError> ate;
    std::optional<RelativeError> rpe_frame, rpe_1s;
    std::string why_no_rpe_frame, why_no_rpe_1s;  ///< where they are missing
};

/// Evaluates an estimate; throws std::invalid_argument for bad options. Missing parts of the result say what
/// the data did not allow, see absolute_error() and relative_error().
Evaluation evaluate(const Trajectory& truth, const Trajectory& estimate, const EvaluationOptions& options);

/// The same for trajectories without timestamps: pose i is compared with pose i, stamps are not looked at,
/// and there is no RPE per second. Throws std::invalid_argument when they are not equally long.
Evaluation evaluate_by_index(const Trajectory& truth, const Trajectory& estimate,
                             const EvaluationOptions& options);

/// The trajectory with pose i at i seconds.
Trajectory stamped_by_index(Trajectory trajectory);

}  // namespace planemap
