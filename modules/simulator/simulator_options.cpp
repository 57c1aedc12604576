// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulator_options.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/joined.hpp"
#include "core/rounding.hpp"
#include "core/sensor_preset.hpp"
#include "core/validation.hpp"
#include "simulator/lens.hpp"

namespace planemap::simulator {

namespace {

constexpr int kMaxFrames = SimulatorOptions::kMaxFrames;

struct KnownWorld {
    World (*make)(std::uint64_t seed, double texel_scale);
    const char* what;
};
const std::map<std::string, KnownWorld>& worlds() {
    static const std::map<std::string, KnownWorld> kWorlds{
        {"appearing", {&make_appearing, "the office from one place; a box appears"}},
        {"building", {&make_building, "a corridor around a block; one round is 100 m"}},
        {"clutter", {&make_clutter, "small boxes any way up: texture, and no plane"}},
        {"door", {&make_door, "the office from one place; its door, closed before, opens"}},
        {"glass", {&make_glass, "the office with a mirror, a pane of glass and a black cupboard"}},
        {"moved", {&make_moved, "the office from one place; a box moves by 35 cm"}},
        {"mural", {&make_mural, "the room of sim:wallpaper, whose pattern never comes again"}},
        {"office", {&make_office, "a furnished room and a corridor; has places to visit"}},
        {"rooms", {&make_rooms, "20 furnished rooms along a corridor, entered one after another"}},
        {"twins", {&make_twins, "two rooms that nothing tells apart, and a corridor"}},
        {"vanishing", {&make_vanishing, "the office from one place; a box vanishes"}},
        {"walker", {&make_walker, "the office from one place; a person walks in, stands and leaves"}},
        {"wall", {&make_wall, "along a wall of bare paint"}},
        {"wallpaper", {&make_wallpaper, "an empty room of 5 x 4 m whose wall pattern repeats every 2 m"}},
    };
    return kWorlds;
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
            throw std::invalid_argument("simulator parameter " + key + " is empty, must be a " +
                                        (option.choices.empty() ? "file" : "name"));
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

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const SensorProfile& profile : sensor_profiles()) names.push_back(profile.name);
    return names;
}

/// A camera at another image size: focal lengths go with the width, the principal point stays in the middle.
PinholeCamera resized(const PinholeCamera& camera, double by_width, double by_height) {
    const auto pixels = [](int size, double by) { return std::max(1, nearest_whole<int>(size * by)); };
    const int width = pixels(camera.width, by_width), height = pixels(camera.height, by_height);
    return {width, height, camera.fx * by_width, camera.fy * by_width, 0.5 * (width - 1), 0.5 * (height - 1)};
}

void add_images_and_walk(OptionList& list, SimulatorOptions& options) {
    list.add("frames", options.frames, {0, kMaxFrames},
             "Frames in all; 0: 900, once around the rooms, or the length of the visits or the trajectory");
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
    list.add("change", options.change_s, {0, 1e6, "s"},
             "When what changes in a world begins to, after the first frame");
}

/// What a sensor does wrong.
void add_errors(OptionList& list, SimulatorOptions& options) {
    std::vector<std::string> profiles = profile_names();
    profiles.insert(profiles.begin(), "");
    list.add(
        "profile", options.profile, profiles,
        "Kind of sensor, " + joined(profile_names()) +
            ": its size, range and noise, and the errors below; empty: a Kinect's noise and no other error");
    list.add("specimen", options.specimen, kAnyNumber, "Which of its kind: decides the errors that stay");
    list.add("sigma", options.sigma, {0, 10}, "Factor of depth's noise; 0: rounding alone");
    list.add("bias", options.bias, {0, 0.2},
             "Error of depth at 4 m that stays, as a share of it, root mean square over the image");
    list.add("focal_error", options.focal_error, {0, 0.1},
             "Share by which the true focal lengths miss camera.json's");
    list.add("mount_error", options.mount_error_deg, {0, 5, "deg"},
             "By which the depth camera is turned beside what camera.json says, and moved by 5 mm each");
    list.add(
        "distortion", options.distortion, {0, 0.1},
        "By which the lens draws an image's corners outwards, as a share of their radius; camera.json does "
        "not say it");
    list.add(
        "lens", options.lens, std::vector<std::string>{},
        "The lens, instead of what `distortion` says, in OpenCV's models: brown:k1,k2,p1,p2[,k3[,k4,k5,k6]] "
        "or fisheye:k1,k2,k3,k4; camera.json says it; empty: none");
    list.add("lens_told", options.lens_told, "0: camera.json says nothing of `lens`");
    list.add(
        "mounted", options.mounted,
        "1: camera.json says body_from_camera: a robot whose x is the optical axis, its origin the camera");
    list.add("motion_noise", options.motion_noise, {0, 1},
             "Share of the way and of the turns by which the robot's own word of its motion is off (see "
             "planemap-simulate --motion-channel)");
    list.add("multipath", options.multipath, {0, 10},
             "Factor of the light that comes over a second surface and makes corners too deep");
    list.add("edges", options.edges, "What a sensor does wrong at edges; 0: nothing");
    list.add("holes", options.holes,
             "Readings that are missing at grazing angles and on bare walls; 0: none");
}

}  // namespace

OptionList options_of(SimulatorOptions& options) {
    OptionList list("Simulator");
    add_images_and_walk(list, options);
    add_errors(list, options);
    return list;
}

void SimulatorOptions::validate() const {
    FieldErrors errors("simulator options");
    errors.require(worlds().contains(world), "world", world, "one of: " + joined(world_names()));
    SimulatorOptions copy = *this;
    options_of(copy).check(errors);
    errors.require(!(depth_max_m <= depth_min_m), "max", depth_max_m, "greater than min");
    if (!lens.empty()) parse_lens(lens);
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
    std::vector<std::string> parameters, seen;
    for (std::size_t from = question; from != std::string::npos;) {
        const auto to = name.find('&', from + 1);
        parameters.push_back(name.substr(from + 1, to == std::string::npos ? to : to - from - 1));
        from = to;
    }
    constexpr std::string_view kProfile = "profile=";
    for (const std::string& parameter : parameters) {
        if (parameter.starts_with(kProfile) && parameter.size() > kProfile.size())
            options.use_profile(parameter.substr(kProfile.size()));
    }
    for (const std::string& parameter : parameters) set_parameter(options, parameter, seen);
    options.validate();
    return options;
}

void SimulatorOptions::use_profile(const std::string& name) {
    const SensorProfile* known = find_sensor_profile(name);
    if (known == nullptr)
        throw std::invalid_argument("simulator parameter profile is \"" + name +
                                    "\", must be one of: " + joined(profile_names()));
    const SensorPreset& preset = *find_sensor_preset(name);
    profile = name;
    width = known->color.width;
    height = known->color.height;
    registered = known->registered;
    depth_min_m = preset.depth_min_m;
    depth_max_m = preset.depth_max_m;
    bias = known->bias;
    focal_error = known->focal_error;
    mount_error_deg = known->mount_error_deg;
    distortion = known->distortion;
    multipath = known->multipath;
}

CameraInfo nominal_camera(const SimulatorOptions& options) {
    CameraInfo camera;
    camera.serial = "sim:" + options.world;
    camera.registered = options.registered;
    camera.depth_units_per_metre = options.depth_units_per_metre;
    camera.depth_min_m = options.depth_min_m;
    camera.depth_max_m = options.depth_max_m;
    if (const SensorProfile* profile = find_sensor_profile(options.profile)) {
        const double by_width = static_cast<double>(options.width) / profile->color.width;
        const double by_height = static_cast<double>(options.height) / profile->color.height;
        camera.serial += " " + options.profile;
        camera.noise = find_sensor_preset(options.profile)->noise;
        camera.color = resized(profile->color, by_width, by_height);
        camera.depth = options.registered ? camera.color : resized(profile->depth, by_width, by_height);
        if (!options.registered) camera.color_from_depth = profile->color_from_depth;
    } else {
        const double scale = options.width / 640.0;
        camera.color = {options.width,
                        options.height,
                        525 * scale,
                        525 * scale,
                        0.5 * (options.width - 1),
                        0.5 * (options.height - 1)};
        camera.depth = camera.color;
        if (!options.registered) {
            camera.depth.fx = camera.depth.fy = 580 * scale;
            Twist twist;
            twist << -0.025, 0.0005, -0.001, 0.003, -0.004, 0.002;
            camera.color_from_depth = pose_from_twist(twist);
        }
    }
    if (!options.lens.empty() && options.lens_told)
        camera.depth_distortion = camera.color_distortion = parse_lens(options.lens);
    if (options.mounted)
        camera.body_from_camera =
            make_pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5));
    camera.validate();
    return camera;
}

DepthSensorOptions depth_options(const SimulatorOptions& options, const CameraInfo& camera) {
    DepthSensorOptions depth;
    depth.noise = options.noise;
    depth.edges = options.edges;
    depth.holes = options.holes;
    depth.units_per_metre = camera.depth_units_per_metre;
    depth.min_m = camera.depth_min_m;
    depth.max_m = camera.depth_max_m;
    depth.sigma = camera.noise;
    depth.sigma.base_m *= options.sigma;
    depth.sigma.quadratic_per_m *= options.sigma;
    if (const SensorProfile* profile = find_sensor_profile(options.profile)) {
        depth.principle = profile->principle;
        depth.baseline_m = profile->baseline_m;
        // Steps of depth are the sensor's, whatever the size of the image.
        depth.disparity_steps *= profile->depth.fx / camera.depth.fx;
    }
    depth.validate();
    return depth;
}

World make_world(const SimulatorOptions& options) {
    // A small image does not show fine texture.
    return worlds().at(options.world).make(options.seed, std::clamp(640.0 / options.width, 0.5, 8.0));
}

}  // namespace planemap::simulator
