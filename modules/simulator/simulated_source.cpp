// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulated_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "core/trajectory_file.hpp"
#include "core/validation.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

namespace {

constexpr std::int64_t kStartUtime = 1000000;
constexpr int kDefaultFrames = 900;

}  // namespace

SimulatedSource::SimulatedSource(const SimulatorOptions& options) : options_(options) {
    options_.validate();
    world_ = make_world(options_);
    camera_ = nominal_camera(options_);
    true_ =
        simulator::true_cameras(camera_, options_.focal_error, options_.mount_error_deg, options_.specimen);
    const auto lens_of = [&](const PinholeCamera& camera) {
        return options_.lens.empty() ? Lens(camera, options_.distortion)
                                     : Lens(camera, parse_lens(options_.lens));
    };
    depth_lens_ = lens_of(true_.depth);
    color_lens_ = lens_of(true_.color);
    depth_options_ = depth_options(options_, camera_);
    if (options_.bias > 0)
        bias_.emplace(depth_options_.principle, options_.bias, true_.depth, options_.specimen);
    if (options_.trajectory.empty()) {
        walk();
    } else {
        follow_trajectory();
    }
}

HandOptions SimulatedSource::hand() const {
    HandOptions hand;
    hand.speed_m_s = options_.speed_m_s * world_.pace;
    hand.turn_deg_s = options_.turn_deg_s * world_.pace;
    return hand;
}

void SimulatedSource::walk() {
    const HandOptions hand = this->hand();
    int frames = kDefaultFrames;
    std::vector<Waypoint> tour = world_.tour;
    if (options_.visits > 0) {
        if (world_.places.size() < 2)
            throw std::invalid_argument("simulator parameter visits: world " + world_.name +
                                        " has no places");
        tour = wander(world_.places, options_.visits, options_.seed);
    }
    if (options_.visits > 0 || world_.whole_tour) {
        const double round_s = tour_duration(tour, hand, options_.seed);
        frames = static_cast<int>(std::min<double>(round_s * options_.rate_hz, SimulatorOptions::kMaxFrames));
    }
    frame_count_ = static_cast<std::size_t>(options_.frames > 0 ? options_.frames : frames);
    const double duration_s = static_cast<double>(frame_count_) / options_.rate_hz + 1;
    path_ = make_hand_path(tour, duration_s, kStartUtime, hand, options_.seed);
}

void SimulatedSource::follow_trajectory() {
    const Trajectory recorded = read_trajectory(options_.trajectory);
    require_poses(options_.trajectory, recorded);
    path_ = fit_path(recorded, world_);
    const auto duration_s = static_cast<double>(path_.back().utime - path_.front().utime) * 1e-6;
    const int longest = static_cast<int>(std::min<double>(duration_s * options_.rate_hz + 0.01,
                                                          SimulatorOptions::kMaxFrames)) +
                        1;
    FieldErrors errors("simulator options");
    errors.require(options_.frames <= longest, "frames", options_.frames,
                   "at most the trajectory's " + std::to_string(longest));
    errors.throw_if_any();
    frame_count_ = static_cast<std::size_t>(options_.frames > 0 ? options_.frames : longest);
}

std::int64_t SimulatedSource::utime(std::size_t i) const {
    return path_.front().utime + std::llround(static_cast<double>(i) * 1e6 / options_.rate_hz);
}

std::int64_t SimulatedSource::color_utime(std::size_t i) const {
    const double jitter_us = 1e6 * options_.color_jitter_s;
    return utime(i) + std::llround(uniform(mix(options_.seed, 31, i), -jitter_us, jitter_us));
}

Pose SimulatedSource::world_from_depth(std::int64_t time_us) const {
    return world_from_color(time_us) * true_.color_from_depth;
}

double SimulatedSource::seconds_of(std::int64_t time_us) const {
    return static_cast<double>(time_us - path_.front().utime) * 1e-6 - options_.change_s;
}

const World& SimulatedSource::world_then(std::int64_t time_us, World& moved) const {
    if (world_.bodies.empty()) return world_;
    return moved = world_at(time_us);
}

View SimulatedSource::depth_view(std::size_t i) const {
    const std::int64_t time = utime(i);
    World moved;
    return render_view(world_then(time, moved), true_.depth, world_from_depth(time));
}

View SimulatedSource::biased_view(std::size_t i) const {
    World moved;
    const World& now = world_then(utime(i), moved);
    View view = render_view(now, depth_lens_->pinhole(), world_from_depth(utime(i)));
    distort(now, view);
    return view;
}

/// Lens, bias and second surfaces.
void SimulatedSource::distort(const World& now, View& view) const {
    if (!depth_lens_->is_pinhole()) view = depth_lens_->distorted(now, view);
    if (options_.multipath > 0) add_multipath(now, view, options_.multipath);
    if (bias_) bias_->apply(view);
}

double SimulatedSource::exposure_at(std::int64_t time_us) const {
    constexpr double kPeriod_s = 7;
    const double swing =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(time_us) * 1e-6 / kPeriod_s);
    return options_.light * (1 - options_.exposure_drift * swing);
}

RgbImage SimulatedSource::color(std::size_t i, const World& now, const View& depth_view) const {
    const PinholeCamera& camera = color_lens_->pinhole();
    LaneImage sum(camera.width, camera.height);
    const std::int64_t middle = color_utime(i);
    const bool same_view = camera_.registered && middle == utime(i) && options_.mount_error_deg == 0;
    const int samples = options_.blur_samples;
    for (int k = 0; k < samples; ++k) {
        const double share = (k + 0.5) / samples - 0.5;
        const std::int64_t time = middle + std::llround(1e6 * options_.shutter_s * share);
        if (same_view && samples == 1) {
            shade(now, depth_view, exposure_at(time), sum);
        } else {
            World moved;
            const World& then = world_then(time, moved);
            shade(then, render_view(then, camera, world_from_color(time)), exposure_at(time), sum);
        }
    }
    if (!color_lens_->is_pinhole()) sum = color_lens_->distorted(sum);
    return sense_color(sum, samples, options_.noise ? options_.color_noise : 0, gaussian_,
                       mix(options_.seed, 37, i));
}

SensorFrame SimulatedSource::frame(std::size_t i) const {
    SensorFrame frame;
    frame.utime = utime(i);
    frame.color_utime = color_utime(i);
    World moved;
    const World& now = world_then(frame.utime, moved);
    View view = render_view(now, depth_lens_->pinhole(), world_from_depth(frame.utime));
    frame.color = color(i, now, view);
    distort(now, view);
    frame.depth = sense_depth(now, view, depth_options_, gaussian_, mix(options_.seed, 41, i));
    return frame;
}

void SimulatedSource::select(const FrameRange& range) {
    std::tie(first_, frame_count_) = frames_within(range, frame_count_);
    next_ = first_;
}

ReadResult SimulatedSource::next(SensorFrame& out) {
    if (next_ == frame_count_) {
        out = {};
        return {ReadResult::Status::kEnd, ""};
    }
    out = frame(next_++);
    return {ReadResult::Status::kFrame, ""};
}

/// Each step is off by a share that stays, and by as much again at random.
Trajectory SimulatedSource::body_motion() const {
    constexpr std::int64_t kStep_us = 20000;
    const Pose camera_from_body = camera_.body_from_camera.value().inverse();
    const double noise = options_.motion_noise;
    Trajectory told;
    Pose last = Pose::Identity(), local_from_body = Pose::Identity();
    std::uint64_t i = 0;
    for (std::int64_t time = utime(first_); time <= utime(frame_count_ - 1) + kStep_us;
         time += kStep_us, ++i) {
        const Pose world_from_body = world_from_color(time) * camera_from_body;
        if (i > 0) {
            const auto factor = [&](std::uint64_t k) {
                return 1 + noise * (uniform(mix(options_.seed, 83, k), -1, 1) +
                                    uniform(mix(options_.seed, 89, i, k), -1, 1));
            };
            Twist step = twist_from_pose(last.inverse() * world_from_body);
            step.head<3>() *= factor(0);
            step.tail<3>() *= factor(1);
            local_from_body = local_from_body * pose_from_twist(step);
        }
        last = world_from_body;
        told.push_back({time, local_from_body});
    }
    return told;
}

Trajectory SimulatedSource::ground_truth() const {
    Trajectory truth;
    for (std::size_t i = first_; i < frame_count_; ++i)
        truth.push_back({utime(i), world_from_color(utime(i))});
    return truth;
}

}  // namespace planemap::simulator
