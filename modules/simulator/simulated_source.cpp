// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulated_source.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "core/files.hpp"
#include "core/option_list.hpp"
#include "core/trajectory_file.hpp"
#include "core/validation.hpp"

namespace planemap::simulator {

namespace {

constexpr std::int64_t kStartUtime = 1000000;
constexpr int kDefaultFrames = 900, kMaxFrames = 1000000;

struct KnownWorld {
    World (*make)(std::uint64_t seed, double texel_scale);
    const char* what;
};
const std::map<std::string, KnownWorld>& worlds() {
    static const std::map<std::string, KnownWorld> kWorlds{
        {"building", {&make_building, "a corridor around a block; one round is 100 m"}},
        {"clutter", {&make_clutter, "small boxes any way up: texture, and no plane"}},
        {"office", {&make_office, "a furnished room and a corridor; has places to visit"}},
        {"twins", {&make_twins, "two rooms that nothing tells apart, and a corridor"}},
        {"wall", {&make_wall, "along a wall of bare paint"}},
    };
    return kWorlds;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

void set_parameter(SimulatorOptions& options, const std::string& parameter, std::vector<std::string>& seen) {
    const auto equals = parameter.find('=');
    const std::string key = parameter.substr(0, equals);
    const OptionList list = options_of(options);
    std::vector<std::string> known;
    for (const Option& option : list.options()) {
        known.push_back(option.name);
        if (option.name != key || equals == std::string::npos) continue;
        if (std::find(seen.begin(), seen.end(), key) != seen.end())
            throw std::invalid_argument("simulator parameter " + key + " is given twice");
        seen.push_back(key);
        const std::string value = parameter.substr(equals + 1);
        const bool is_text = std::holds_alternative<std::string*>(option.field);
        if (is_text && value.empty())
            throw std::invalid_argument("simulator parameter " + key + " is empty, must be a file");
        try {
            option.set(value);
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(std::string("simulator parameter ") + error.what());
        }
        return;
    }
    throw std::invalid_argument("\"" + parameter +
                                "\" is not a simulator parameter; KEY=VALUE with a key of: " + joined(known));
}

CameraInfo make_camera(const SimulatorOptions& options) {
    const double scale = options.width / 640.0;
    CameraInfo camera;
    camera.serial = "sim:" + options.world;
    camera.color = {options.width,
                    options.height,
                    525 * scale,
                    525 * scale,
                    0.5 * (options.width - 1),
                    0.5 * (options.height - 1)};
    camera.depth = camera.color;
    camera.registered = options.registered;
    if (!options.registered) {
        camera.depth.fx = camera.depth.fy = 580 * scale;
        Twist twist;
        twist << -0.025, 0.0005, -0.001, 0.003, -0.004, 0.002;
        camera.color_from_depth = pose_from_twist(twist);
    }
    camera.depth_units_per_metre = options.depth_units_per_metre;
    camera.depth_min_m = options.depth_min_m;
    camera.depth_max_m = options.depth_max_m;
    camera.validate();
    return camera;
}

DepthSensorOptions make_depth_options(const SimulatorOptions& options, const CameraInfo& camera) {
    DepthSensorOptions depth;
    depth.noise = options.noise;
    depth.units_per_metre = camera.depth_units_per_metre;
    depth.min_m = camera.depth_min_m;
    depth.max_m = camera.depth_max_m;
    depth.sigma = camera.noise;
    depth.validate();
    return depth;
}

nlohmann::json to_json(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

OptionList options_of(SimulatorOptions& options) {
    OptionList list("Simulator");
    list.add("frames", options.frames, {0, kMaxFrames},
             "Frames in all; 0: 900, or the length of the visits or the trajectory");
    list.add("seed", options.seed, kAnyNumber, "Of textures, walk and noise");
    list.add("rate", options.rate_hz, {0.1, 1000, "Hz"}, "Frames a second");
    list.add("width", options.width, {16, 4096, "px"}, "Of both images");
    list.add("height", options.height, {16, 4096, "px"}, "Of both images");
    list.add("noise", options.noise, "Of depth and colour; 0: none");
    list.add("registered", options.registered, "0: depth from a camera of its own, 2.5 cm beside");
    list.add("units", options.depth_units_per_metre,
             {CameraLimits::kLeastUnits, CameraLimits::kMostUnits, "1/m"}, "Of the raw depth");
    list.add("min", options.depth_min_m, {0, 100, "m"}, "Least depth that is sensed");
    list.add("max", options.depth_max_m, {0, 1000, "m"}, "Largest depth that is sensed; more than min");
    list.add("color_noise", options.color_noise, {0, 50}, "Standard deviation of colour, of 255 levels");
    list.add("blur", options.blur_samples, {1, 16}, "Views that are averaged for motion blur; 1: none");
    list.add("shutter", options.shutter_s, {0, 1, "s"}, "Exposure time of colour with motion blur");
    list.add("jitter", options.color_jitter_s, {0, 5, "s"},
             "Colour is taken up to this much before or after depth; at most half a frame");
    list.add("drift", options.exposure_drift, {0, 0.5}, "Share by which brightness swings");
    list.add("light", options.light, kShare, "Brightness; 0: darkness, and noise alone");
    list.add("speed", options.speed_m_s, {0.01, 10, "m/s"}, "Of the walk, where it does not turn");
    list.add("turn", options.turn_deg_s, {1, 1000, "deg/s"}, "Of the walk, where it stands");
    list.add("visits", options.visits, {0, 10000},
             "The walk visits the world's places in random order, so many in all; 0: it goes its tour");
    list.add("trajectory", options.trajectory, std::vector<std::string>{},
             "File of a recorded hand-held trajectory to follow, TUM format, its world's y pointing down; "
             "empty: the world's own walk");
    return list;
}

void SimulatorOptions::validate() const {
    FieldErrors errors("simulator options");
    errors.require(worlds().contains(world), "world", world, "one of: " + joined(world_names()));
    SimulatorOptions copy = *this;
    options_of(copy).check(errors);
    errors.require(!(depth_max_m <= depth_min_m), "max", depth_max_m, "greater than min");
    errors.require(!(color_jitter_s > 0.5 / rate_hz), "jitter", color_jitter_s, "at most half a frame");
    errors.throw_if_any();
}

std::vector<std::string> world_names() {
    std::vector<std::string> names;
    for (const auto& [name, unused] : worlds()) names.push_back(name);
    return names;
}

std::string simulator_help() {
    std::string text = "Simulated worlds:\n";
    for (const auto& [name, world] : worlds())
        text += "  sim:" + name + std::string(12 - name.size(), ' ') + world.what + "\n";
    text += "with parameters, as in sim:office?frames=300&seed=7:\n";
    SimulatorOptions defaults;
    const OptionList list = options_of(defaults);
    for (const Option& option : list.options()) {
        const std::string range = option.range_and_unit();
        text += "  " + option.name + std::string(13 - option.name.size(), ' ') + option.help +
                (range.empty() ? "" : " [" + range + "]") + "\n";
    }
    text.pop_back();
    return text;
}

SimulatorOptions parse_simulator_name(const std::string& name) {
    if (!name.starts_with("sim:")) throw std::invalid_argument("\"" + name + "\" does not start with sim:");
    SimulatorOptions options;
    const auto question = name.find('?');
    options.world = name.substr(4, question == std::string::npos ? question : question - 4);
    std::vector<std::string> seen;
    for (std::size_t from = question; from != std::string::npos;) {
        const auto to = name.find('&', from + 1);
        set_parameter(options, name.substr(from + 1, to == std::string::npos ? to : to - from - 1), seen);
        from = to;
    }
    options.validate();
    return options;
}

SimulatedSource::SimulatedSource(const SimulatorOptions& options) : options_(options) {
    options_.validate();
    // A small image does not show fine texture.
    world_ = worlds().at(options_.world).make(options_.seed, std::clamp(640.0 / options_.width, 0.5, 8.0));
    camera_ = make_camera(options_);
    depth_options_ = make_depth_options(options_, camera_);
    if (options_.trajectory.empty()) {
        walk();
    } else {
        follow_trajectory();
    }
}

void SimulatedSource::walk() {
    HandOptions hand;
    hand.speed_m_s = options_.speed_m_s;
    hand.turn_deg_s = options_.turn_deg_s;
    int frames = kDefaultFrames;
    std::vector<Waypoint> tour = world_.tour;
    if (options_.visits > 0) {
        if (world_.places.size() < 2)
            throw std::invalid_argument("simulator parameter visits: world " + world_.name +
                                        " has no places");
        tour = wander(world_.places, options_.visits, options_.seed);
        const double round_s = tour_duration(tour, hand, options_.seed);
        frames = static_cast<int>(std::min<double>(round_s * options_.rate_hz, kMaxFrames));
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
    const int longest =
        static_cast<int>(std::min<double>(duration_s * options_.rate_hz + 0.01, kMaxFrames)) + 1;
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
    return world_from_color(time_us) * camera_.color_from_depth;
}

View SimulatedSource::depth_view(std::size_t i) const {
    return render_view(world_, camera_.depth, world_from_depth(utime(i)));
}

double SimulatedSource::exposure_at(std::int64_t time_us) const {
    constexpr double kPeriod_s = 7;
    const double swing =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(time_us) * 1e-6 / kPeriod_s);
    return options_.light * (1 - options_.exposure_drift * swing);
}

RgbImage SimulatedSource::color(std::size_t i, const View& depth_view) const {
    LaneImage sum(camera_.color.width, camera_.color.height);
    const std::int64_t middle = color_utime(i);
    const bool same_view = camera_.registered && middle == utime(i);
    const int samples = options_.blur_samples;
    for (int k = 0; k < samples; ++k) {
        const double share = (k + 0.5) / samples - 0.5;
        const std::int64_t time = middle + std::llround(1e6 * options_.shutter_s * share);
        if (same_view && samples == 1) {
            shade(world_, depth_view, exposure_at(time), sum);
        } else {
            shade(world_, render_view(world_, camera_.color, world_from_color(time)), exposure_at(time), sum);
        }
    }
    return sense_color(sum, samples, options_.noise ? options_.color_noise : 0, gaussian_,
                       mix(options_.seed, 37, i));
}

SensorFrame SimulatedSource::frame(std::size_t i) const {
    SensorFrame frame;
    frame.utime = utime(i);
    frame.color_utime = color_utime(i);
    const View view = depth_view(i);
    frame.depth = sense_depth(world_, view, depth_options_, gaussian_, mix(options_.seed, 41, i));
    frame.color = color(i, view);
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

Trajectory SimulatedSource::ground_truth() const {
    Trajectory truth;
    for (std::size_t i = first_; i < frame_count_; ++i)
        truth.push_back({utime(i), world_from_color(utime(i))});
    return truth;
}

void write_planes_truth(const std::filesystem::path& file, const World& world, const std::string& log) {
    nlohmann::json planes = nlohmann::json::array();
    for (std::size_t id = 0; id < world.surfaces.size(); ++id) {
        const Surface& surface = world.surfaces[id];
        nlohmann::json rectangles = nlohmann::json::array();
        double area = 0;
        for (const Rectangle& rectangle : world.rectangles) {
            if (rectangle.surface != static_cast<int>(id) || rectangle.picture) continue;
            nlohmann::json corners = nlohmann::json::array();
            for (const Eigen::Vector3d& corner : rectangle.corners()) corners.push_back(to_json(corner));
            rectangles.push_back(corners);
            area += 4 * rectangle.half_u.norm() * rectangle.half_v.norm();
        }
        planes.push_back({{"id", id},
                          {"name", surface.name},
                          {"normal", to_json(surface.plane.normal)},
                          {"d", surface.plane.d},
                          {"area", area},
                          {"rectangles", rectangles}});
    }
    nlohmann::json truth{{"world", world.name}, {"planes", planes}};
    if (!log.empty()) truth["log"] = log;
    write_file(file, truth.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace planemap::simulator
