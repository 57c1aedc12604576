// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/angle.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Camera axes (columns: right, down, forward) for a gaze in a world with z up.
Matrix3d looking(const Vector3d& gaze) {
    const Vector3d forward = gaze.normalized();
    const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
    Matrix3d world_from_camera;
    world_from_camera << right, forward.cross(right), forward;
    return world_from_camera;
}

/// A closed uniform cubic B-spline over waypoints; the parameter counts waypoints.
class Tour {
  public:
    Tour(std::vector<Waypoint> waypoints, const HandOptions& options) : waypoints_(std::move(waypoints)) {
        constexpr int kSteps = 64;
        times_.push_back(0);
        Waypoint previous = at(0);
        const auto count = static_cast<int>(waypoints_.size()) * kSteps;
        for (int i = 1; i <= count; ++i) {
            const Waypoint next = at(static_cast<double>(i) / kSteps);
            const Vector3d gaze = next.target - next.position,
                           gaze_before = previous.target - previous.position;
            const double turned = std::atan2(gaze.cross(gaze_before).norm(), gaze.dot(gaze_before));
            times_.push_back(times_.back() +
                             std::hypot((next.position - previous.position).norm() / options.speed_m_s,
                                        turned / radians(options.turn_deg_s)));
            previous = next;
        }
    }

    double duration() const { return times_.back(); }

    /// Where the walk is after so many seconds.
    Waypoint after(double seconds) const {
        const double time = std::fmod(seconds, duration());
        const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
        const double share = (time - *(next - 1)) / (*next - *(next - 1));
        const double steps = static_cast<double>(next - 1 - times_.begin()) + share;
        return at(steps / static_cast<double>(times_.size() - 1) * static_cast<double>(waypoints_.size()));
    }

  private:
    Waypoint at(double parameter) const {
        const double whole = std::floor(parameter), t = parameter - whole;
        const double weights[4] = {(1 - t) * (1 - t) * (1 - t) / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                   (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6};
        Waypoint point{Vector3d::Zero(), Vector3d::Zero()};
        for (std::size_t i = 0; i < 4; ++i) {
            const auto index =
                (static_cast<std::size_t>(whole) + i + waypoints_.size() - 1) % waypoints_.size();
            point.position += weights[i] * waypoints_[index].position;
            point.target += weights[i] * waypoints_[index].target;
        }
        return point;
    }

    std::vector<Waypoint> waypoints_;
    std::vector<double> times_;
};

Tour make_tour(std::vector<Waypoint> waypoints, const HandOptions& options, std::uint64_t seed) {
    std::uint64_t count = 0;
    const auto scatter = [&](Vector3d& p, double by) {
        for (double& coordinate : p) coordinate += uniform(mix(seed, 17, count++), -by, by);
    };
    for (Waypoint& waypoint : waypoints) {
        scatter(waypoint.position, options.waypoint_scatter_m);
        scatter(waypoint.target, 3 * options.waypoint_scatter_m);
    }
    return {std::move(waypoints), options};
}

/// Sums of a few slow sine waves, one for each of six directions, of unit amplitude together.
class Tremor {
  public:
    explicit Tremor(std::uint64_t seed) : seed_(seed) {}

    Twist at(double seconds) const {
        constexpr std::uint64_t kWaves = 3;
        Twist twist = Twist::Zero();
        for (std::uint64_t i = 0; i < 6; ++i) {
            for (std::uint64_t wave = 0; wave < kWaves; ++wave) {
                const double frequency = uniform(mix(seed_, i, wave, 1), 0.8, 3.0);
                const double phase = uniform(mix(seed_, i, wave, 2), 0, 2 * std::numbers::pi);
                twist[static_cast<Eigen::Index>(i)] +=
                    std::sin(2 * std::numbers::pi * frequency * seconds + phase) /
                    (kWaves * std::max(1.0, frequency));
            }
        }
        return twist;
    }

  private:
    std::uint64_t seed_;
};

}  // namespace

Trajectory make_hand_path(const std::vector<Waypoint>& waypoints, double duration_s, std::int64_t start_utime,
                          const HandOptions& options, std::uint64_t seed) {
    constexpr double kRate = 120;
    const Tour tour = make_tour(waypoints, options, seed);
    const Tremor tremor(mix(seed, 23));
    Trajectory path;
    const auto count = static_cast<int>(std::ceil(duration_s * kRate)) + 2;
    for (int i = 0; i < count; ++i) {
        const double seconds = i / kRate;
        const Waypoint point = tour.after(seconds);
        Twist shake = tremor.at(seconds);
        shake.head<3>() *= options.tremor_m;
        shake.tail<3>() *= radians(options.tremor_deg);
        Pose smooth = Pose::Identity();
        smooth.linear() = looking(point.target - point.position);
        smooth.translation() = point.position;
        path.push_back({start_utime + std::llround(seconds * 1e6), smooth * pose_from_twist(shake)});
    }
    return path;
}

std::vector<Waypoint> wander(const std::vector<Waypoint>& places, int visits, std::uint64_t seed) {
    constexpr double kStep_m = 0.4, kTurn = radians(30);
    constexpr int kStand = 3;  // a spline goes through a point that is given three times
    std::vector<Waypoint> walk;
    std::size_t here = mix(seed, 29) % places.size();
    for (int visit = 0; visit < visits; ++visit) {
        walk.insert(walk.end(), kStand, places[here]);
        const auto random = static_cast<std::size_t>(mix(seed, 29, static_cast<std::uint64_t>(visit) + 1));
        const std::size_t next = (here + 1 + random % (places.size() - 1)) % places.size();
        const Waypoint &from = places[here], &to = places[next];
        const Vector3d gaze = from.target - from.position, gaze_then = to.target - to.position;
        const double turn = std::remainder(
            std::atan2(gaze_then.y(), gaze_then.x()) - std::atan2(gaze.y(), gaze.x()), 2 * std::numbers::pi);
        const double length = std::hypot(gaze.x(), gaze.y());
        const double length_then = std::hypot(gaze_then.x(), gaze_then.y());
        const double steps =
            std::ceil(std::max((to.position - from.position).norm() / kStep_m, std::abs(turn) / kTurn));
        for (double step = 1; step < steps; ++step) {
            const double share = step / steps;
            const double yaw = std::atan2(gaze.y(), gaze.x()) + share * turn;
            const double reach = std::lerp(length, length_then, share);
            const Vector3d position = from.position + share * (to.position - from.position);
            walk.push_back({position, position + Vector3d(reach * std::cos(yaw), reach * std::sin(yaw),
                                                          std::lerp(gaze.z(), gaze_then.z(), share))});
        }
        here = next;
    }
    return walk;
}

double tour_duration(const std::vector<Waypoint>& tour, const HandOptions& options, std::uint64_t seed) {
    return make_tour(tour, options, seed).duration();
}

Trajectory fit_path(const Trajectory& recorded, const World& world) {
    Matrix3d up_from_down;  // x stays, the recording's y (down) becomes -z
    up_from_down << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    constexpr std::size_t kSamples = 40;
    constexpr double kStep = 0.2;
    std::vector<Vector3d> samples;
    for (std::size_t i = 0; i < kSamples; ++i) {
        const auto index = i * (recorded.size() - 1) / (kSamples - 1);
        samples.push_back(up_from_down * recorded[index].world_from_camera.translation());
    }
    double best_clearance = -1;
    Pose best = Pose::Identity();
    for (int turn = 0; turn < 12; ++turn) {
        Pose candidate = Pose::Identity();
        candidate.linear() = Eigen::AngleAxisd(radians(turn * 30), Vector3d::UnitZ()).toRotationMatrix();
        Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (const Vector3d& p : samples) {
            low = low.cwiseMin(candidate.linear() * p);
            high = high.cwiseMax(candidate.linear() * p);
        }
        // Every place in the free box that holds the path; in the middle where it is too long for that.
        const Vector3d slack = 0.5 * (world.free_to - world.free_from - (high - low)).cwiseMax(0.0);
        const Vector3d middle = 0.5 * (world.free_from + world.free_to - low - high);
        const double lift = low.z() < world.free_from.z() || high.z() > world.free_to.z() ? middle.z() : 0;
        for (double x = -slack.x(); x <= slack.x(); x += kStep) {
            for (double y = -slack.y(); y <= slack.y(); y += kStep) {
                candidate.translation() = Vector3d(middle.x() + x, middle.y() + y, lift);
                double clearance = std::numeric_limits<double>::infinity();
                for (const Vector3d& p : samples) {
                    if (clearance <= best_clearance) break;
                    clearance = std::min(clearance, world.clearance(candidate * p));
                }
                if (clearance > best_clearance) {
                    best_clearance = clearance;
                    best = candidate;
                }
            }
        }
    }
    best.linear() = best.linear() * up_from_down;
    Trajectory path = recorded;
    for (StampedPose& pose : path) pose.world_from_camera = orthonormalised(best * pose.world_from_camera);
    return path;
}

Pose pose_at(const Trajectory& trajectory, std::int64_t utime) {
    const auto next =
        std::upper_bound(trajectory.begin(), trajectory.end(), utime,
                         [](std::int64_t t, const StampedPose& pose) { return t < pose.utime; });
    if (next == trajectory.begin()) return trajectory.front().world_from_camera;
    if (next == trajectory.end()) return trajectory.back().world_from_camera;
    const StampedPose &a = *(next - 1), &b = *next;
    const double fraction = static_cast<double>(utime - a.utime) / static_cast<double>(b.utime - a.utime);
    return interpolate(a.world_from_camera, b.world_from_camera, fraction);
}

}  // namespace planemap::simulator
