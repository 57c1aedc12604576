// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/geometry/angle.hpp"
#include "core/geometry/rigid_fit.hpp"
#include "core/validation.hpp"

namespace planemap {

namespace {

constexpr std::int64_t kSameMomentUs = 5000, kMaxTruthGapUs = 100000;

std::int64_t microseconds(double seconds) {
    return std::llround(seconds * 1e6);
}

/// Index of the value nearest to t in sorted, non-empty values. Where two are as near, the one that halving
/// meets first, as in evaluate_rpe.py: find_closest_index.
std::size_t closest_index(const std::vector<double>& values, double t) {
    std::size_t best = 0, begin = 0, end = values.size();
    double difference = std::abs(values[0] - t);
    while (begin < end) {
        const std::size_t middle = (begin + end) / 2;
        if (std::abs(values[middle] - t) < difference) {
            difference = std::abs(values[middle] - t);
            best = middle;
        }
        if (values[middle] == t) return middle;
        if (values[middle] > t) {
            end = middle;
        } else {
            begin = middle + 1;
        }
    }
    return best;
}

/// Stamps in microseconds, which a double holds exactly.
std::vector<double> stamps_of(const Trajectory& trajectory) {
    std::vector<double> stamps;
    stamps.reserve(trajectory.size());
    for (const StampedPose& pose : trajectory) stamps.push_back(static_cast<double>(pose.utime));
    return stamps;
}

/// Motion from pose a to pose b as evaluate_rpe.py's ominus(b, a) writes it: camera b from camera a.
Pose relative_motion(const Pose& world_from_a, const Pose& world_from_b) {
    return world_from_b.inverse() * world_from_a;
}

/// For each pose how far along the trajectory it is: microseconds, metres, radians, degrees or poses.
std::vector<double> distances_along(const Trajectory& trajectory, DeltaUnit unit) {
    if (unit == DeltaUnit::seconds) return stamps_of(trajectory);
    std::vector<double> distances;
    double distance = 0.0;
    for (const StampedPose& pose : trajectory) {
        const StampedPose& previous = distances.empty() ? pose : trajectory[distances.size() - 1];
        const Pose motion = relative_motion(previous.world_from_camera, pose.world_from_camera);
        if (unit == DeltaUnit::metres) distance += motion.translation().norm();
        if (unit == DeltaUnit::radians) distance += rotation_angle(motion);
        if (unit == DeltaUnit::degrees) distance += degrees(rotation_angle(motion));
        if (unit == DeltaUnit::frames) distance = static_cast<double>(distances.size());
        distances.push_back(distance);
    }
    return distances;
}

/// Pairs of poses of the estimate that are delta apart.
std::vector<std::pair<std::size_t, std::size_t>> delta_pairs(const Trajectory& estimate, const Delta& delta) {
    const std::vector<double> along = distances_along(estimate, delta.unit);
    const double step = delta.unit == DeltaUnit::seconds ? std::round(delta.value * 1e6) : delta.value;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < along.size(); ++i) {
        const std::size_t j = closest_index(along, along[i] + step);
        if (j != along.size() - 1) pairs.emplace_back(i, j);
    }
    return pairs;
}

double median_interval(const std::vector<double>& stamps) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
    return statistics(std::move(intervals)).median;
}

/// The truth at a time, as relative_error() takes it.
std::optional<Pose> truth_at(const Trajectory& truth, const std::vector<double>& stamps_us,
                             std::int64_t utime) {
    const std::size_t nearest = closest_index(stamps_us, static_cast<double>(utime));
    if (std::abs(truth[nearest].utime - utime) <= kSameMomentUs) return truth[nearest].world_from_camera;
    return pose_at(truth, utime, kMaxTruthGapUs);
}

Eigen::Matrix3Xd matched_positions(const Trajectory& trajectory, const std::vector<PosePair>& pairs,
                                   bool truth) {
    Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const std::size_t pose = truth ? pairs[i].first : pairs[i].second;
        positions.col(static_cast<Eigen::Index>(i)) = trajectory[pose].world_from_camera.translation();
    }
    return positions;
}

}  // namespace

void EvaluationOptions::validate() const {
    FieldErrors errors("EvaluationOptions");
    errors.require(max_difference_s > 0 && max_difference_s <= 1e9, "max_difference_s", max_difference_s,
                   "greater than 0 and at most 1e9");
    errors.require(std::abs(offset_s) <= 1e9, "offset_s", offset_s, "from -1e9 to 1e9");
    errors.require(std::isfinite(scale) && scale > 0, "scale", scale, "greater than 0");
    errors.throw_if_any();
}

std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                const EvaluationOptions& options) {
    const std::int64_t offset = microseconds(options.offset_s);
    const std::int64_t limit = microseconds(options.max_difference_s);
    std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> candidates;
    std::size_t window = 0;
    for (std::size_t e = 0; e < estimate.size(); ++e) {
        const std::int64_t stamp = estimate[e].utime + offset;
        while (window < truth.size() && truth[window].utime <= stamp - limit) ++window;
        for (std::size_t t = window; t < truth.size() && truth[t].utime < stamp + limit; ++t) {
            candidates.emplace_back(std::abs(truth[t].utime - stamp), t, e);
        }
    }
    std::sort(candidates.begin(), candidates.end());

    std::vector<PosePair> pairs;
    std::vector<bool> truth_used(truth.size(), false), estimate_used(estimate.size(), false);
    for (const auto& [difference, t, e] : candidates) {
        if (truth_used[t] || estimate_used[e]) continue;
        truth_used[t] = estimate_used[e] = true;
        pairs.emplace_back(t, e);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::optional<AbsoluteError> absolute_error(const Trajectory& truth, const Trajectory& estimate,
                                            const std::vector<PosePair>& pairs, double scale) {
    if (pairs.size() < 3) return std::nullopt;
    const Eigen::Matrix3Xd data = matched_positions(truth, pairs, true);
    const Eigen::Matrix3Xd model = scale * matched_positions(estimate, pairs, false);

    AbsoluteError result;
    result.truth_from_estimate = rigid_fit(data, model);

    const Eigen::Matrix3Xd data_centred = data.colwise() - data.rowwise().mean();
    const Eigen::Matrix3Xd model_centred = model.colwise() - model.rowwise().mean();
    const Eigen::Matrix3Xd aligned = result.truth_from_estimate.linear() * model_centred;
    const Eigen::VectorXd errors = (aligned - data_centred).colwise().norm().transpose();
    result.metres = statistics({errors.begin(), errors.end()});
    result.scale = data_centred.cwiseProduct(aligned).sum() / aligned.squaredNorm();
    return result;
}

std::optional<RelativeError> relative_error(const Trajectory& truth, const Trajectory& estimate,
                                            const Delta& delta, const EvaluationOptions& options) {
    if (truth.size() < 2 || estimate.size() < 2) return std::nullopt;
    const std::vector<double> truth_stamps_us = stamps_of(truth);
    const std::int64_t offset = microseconds(options.offset_s);
    RelativeError result;
    std::vector<double> errors_m, errors_deg;
    for (const auto& [i, j] : delta_pairs(estimate, delta)) {
        const auto first = truth_at(truth, truth_stamps_us, estimate[i].utime + offset);
        const auto second = truth_at(truth, truth_stamps_us, estimate[j].utime + offset);
        if (!first || !second) {
            ++result.left_out;
            continue;
        }
        Pose motion = relative_motion(estimate[i].world_from_camera, estimate[j].world_from_camera);
        motion.translation() *= options.scale;
        const Pose error = motion.inverse() * relative_motion(*first, *second);
        errors_m.push_back(error.translation().norm());
        errors_deg.push_back(degrees(rotation_angle(error)));
    }
    if (errors_m.size() < 2) return std::nullopt;
    result.metres = statistics(std::move(errors_m));
    result.degrees = statistics(std::move(errors_deg));
    return result;
}

std::string why_no_relative_error(const Trajectory& truth, const Trajectory& estimate, const Delta& delta) {
    if (truth.size() < 2 || estimate.size() < 2 || delta_pairs(estimate, delta).size() < 2)
        return "too few pairs that far apart";
    const double interval_us = median_interval(stamps_of(truth));
    if (interval_us <= static_cast<double>(kMaxTruthGapUs))
        return "not measured: the truth has no poses at the estimate's times";
    char text[200];
    std::snprintf(
        text, sizeof(text),
        "not measured: the truth has poses %.3g s apart (median), too far to know it at the estimate's "
        "times; at most %g s are interpolated",
        1e-6 * interval_us, 1e-6 * static_cast<double>(kMaxTruthGapUs));
    return text;
}

double matched_path_length(const Trajectory& truth, const std::vector<PosePair>& pairs) {
    double length = 0.0;
    if (pairs.empty()) return length;
    for (std::size_t i = pairs.front().first; i < pairs.back().first; ++i) {
        length +=
            (truth[i + 1].world_from_camera.translation() - truth[i].world_from_camera.translation()).norm();
    }
    return length;
}

double matched_extent(const Trajectory& truth, const std::vector<PosePair>& pairs) {
    if (pairs.empty()) return 0;
    const auto count = static_cast<double>(pairs.size());
    const auto position = [&](const PosePair& pair) -> Eigen::Vector3d {
        return truth[pair.first].world_from_camera.translation();
    };
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const PosePair& pair : pairs) middle += position(pair) / count;
    double square = 0;
    for (const PosePair& pair : pairs) square += (position(pair) - middle).squaredNorm() / count;
    return std::sqrt(square);
}

Trajectory without_repeated_stamps(const Trajectory& trajectory) {
    Trajectory unique;
    unique.reserve(trajectory.size());
    for (const StampedPose& pose : trajectory) {
        if (!unique.empty() && unique.back().utime == pose.utime) unique.pop_back();
        unique.push_back(pose);
    }
    return unique;
}

Evaluation evaluate(const Trajectory& truth_poses, const Trajectory& estimate_poses,
                    const EvaluationOptions& options) {
    options.validate();
    const Trajectory truth = without_repeated_stamps(truth_poses);
    const Trajectory estimate = without_repeated_stamps(estimate_poses);
    const std::vector<PosePair> pairs = associate(truth, estimate, options);

    Evaluation result;
    result.truth_poses = truth.size();
    result.estimate_poses = estimate.size();
    result.pairs = pairs.size();
    if (!estimate.empty()) {
        result.matched_share = static_cast<double>(pairs.size()) / static_cast<double>(estimate.size());
    }
    result.path_length_m = matched_path_length(truth, pairs);
    result.extent_m = matched_extent(truth, pairs);
    result.ate = absolute_error(truth, estimate, pairs, options.scale);
    constexpr Delta kFrame{1.0, DeltaUnit::frames}, kSecond{1.0, DeltaUnit::seconds};
    result.rpe_frame = relative_error(truth, estimate, kFrame, options);
    result.rpe_1s = relative_error(truth, estimate, kSecond, options);
    if (!result.rpe_frame) result.why_no_rpe_frame = why_no_relative_error(truth, estimate, kFrame);
    if (!result.rpe_1s) result.why_no_rpe_1s = why_no_relative_error(truth, estimate, kSecond);
    return result;
}

Trajectory stamped_by_index(Trajectory trajectory) {
    for (std::size_t i = 0; i < trajectory.size(); ++i)
        trajectory[i].utime = static_cast<std::int64_t>(i) * 1000000;
    return trajectory;
}

Evaluation evaluate_by_index(const Trajectory& truth, const Trajectory& estimate,
                             const EvaluationOptions& options) {
    if (truth.size() != estimate.size()) {
        throw std::invalid_argument("pose i is compared with pose i, but the truth has " +
                                    std::to_string(truth.size()) + " poses and the estimate " +
                                    std::to_string(estimate.size()));
    }
    EvaluationOptions by_index = options;
    by_index.offset_s = 0;
    by_index.max_difference_s = 0.02;  // stamps are whole seconds: only equal ones match
    Evaluation result = evaluate(stamped_by_index(truth), stamped_by_index(estimate), by_index);
    result.rpe_1s = std::nullopt;
    result.why_no_rpe_1s = "not measured: the poses have no timestamps";
    return result;
}

}  // namespace planemap
