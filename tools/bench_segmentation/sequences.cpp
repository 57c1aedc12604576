// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/sequences.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "core/camera_file.hpp"
#include "core/geometry/angle.hpp"
#include "core/geometry/moments.hpp"
#include "core/trajectory.hpp"
#include "core/undistortion.hpp"
#include "segment/read_image.hpp"
#include "sensor/dataset.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::bench {

namespace {

constexpr std::int64_t kMaxPoseGap_us = 100'000;
constexpr int kFrames = 60;  // of a sequence that does not say

/// A recording in the TUM layout: depth, and poses where there are some.
Sequence open_recording(const std::filesystem::path& folder, std::size_t frames) {
    const auto dataset = std::make_shared<const sensor::Dataset>(folder);
    const auto undistortion = std::make_shared<const Undistortion>(dataset->camera());
    const CameraInfo& camera = undistortion->pinhole();
    Trajectory truth;
    if (std::filesystem::exists(folder / "groundtruth.txt"))
        truth = read_trajectory(folder / "groundtruth.txt");
    const auto load = [=](std::size_t index) {
        const sensor::ListedImage& listed = dataset->frames()[index].depth;
        BenchFrame frame;
        frame.depth = read_image(folder / listed.file, camera, sensor::decode_depth_png);
        undistortion->undistort(frame.depth);
        if (const auto world_from_color = pose_at(truth, listed.utime, kMaxPoseGap_us))
            frame.world_from_depth = *world_from_color * camera.color_from_depth;
        return frame;
    };
    return {folder.filename(), camera, evenly_spread(dataset->frames().size(), frames), load};
}

/// The least-squares plane of each surface's points.
std::vector<Plane> fit_surfaces(const Image<std::uint16_t>& surfaces, const DepthImage& depth,
                                const CameraInfo& camera) {
    std::vector<Moments> moments;
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const std::size_t surface = surfaces(u, v);
            if (surface == 0 || !is_valid_depth(depth(u, v))) continue;
            if (moments.size() < surface) moments.resize(surface);
            moments[surface - 1].add(camera.depth.unproject(u, v, camera.metres(depth(u, v))));
        }
    }
    std::vector<Plane> planes;
    planes.reserve(moments.size());
    for (const Moments& m : moments) planes.push_back(fit_plane(m).plane);
    return planes;
}

/// Images with a label image each: one colour a plane, black for none. True planes are fitted to the depth.
Sequence open_labelled(const std::filesystem::path& folder, std::size_t frames) {
    const CameraInfo camera = read_camera_file(folder / "camera.json");
    if (camera.depth_distortion)
        throw std::invalid_argument((folder / "camera.json").string() +
                                    ": labels are of a lens's image, not a pinhole's");
    std::size_t count = 0;
    while (std::filesystem::exists(folder / (std::to_string(count) + ".depth.png"))) ++count;
    const auto load = [=](std::size_t index) {
        const std::string stem = (folder / std::to_string(index)).string();
        BenchFrame frame;
        frame.depth = read_image(stem + ".depth.png", camera, sensor::decode_depth_png);
        const RgbImage colors = read_image(stem + ".labels.png", camera, sensor::decode_color_png);
        Image<std::uint16_t> surfaces(colors.width, colors.height);
        std::map<std::tuple<int, int, int>, std::uint16_t> surface_of{{{0, 0, 0}, std::uint16_t{0}}};
        for (std::size_t i = 0; i < colors.pixels.size(); ++i) {
            const Rgb& c = colors.pixels[i];
            surfaces.pixels[i] =
                surface_of.try_emplace({c.r, c.g, c.b}, static_cast<std::uint16_t>(surface_of.size()))
                    .first->second;
        }
        std::vector<Plane> planes = fit_surfaces(surfaces, frame.depth, camera);
        planes.resize(surface_of.size());
        frame.truth = make_truth(surfaces, planes, frame.depth, camera);
        return frame;
    };
    return {folder.filename(), camera, evenly_spread(count, frames), load};
}

/// For each surface of a world the first one on the same plane (within 1 mm and 0.06 deg) that faces the same
/// way: two cupboards in a row show one plane.
std::vector<std::size_t> first_on_same_plane(const simulator::World& world) {
    std::vector<std::size_t> first;
    for (const simulator::Surface& surface : world.surfaces) {
        const auto same = std::find_if(world.surfaces.begin(), world.surfaces.end(), [&](const auto& other) {
            return angle_between(surface.plane.normal, other.plane.normal) < 1e-3 &&
                   std::abs(surface.plane.d - other.plane.d) < 1e-3;
        });
        first.push_back(static_cast<std::size_t>(same - world.surfaces.begin()));
    }
    return first;
}

Truth truth_of_view(const simulator::World& world, const simulator::View& view, const DepthImage& depth,
                    const CameraInfo& camera) {
    const std::vector<std::size_t> first = first_on_same_plane(world);
    const Pose camera_from_world = view.world_from_camera.inverse();
    std::vector<Plane> planes;
    planes.reserve(world.surfaces.size());
    for (const simulator::Surface& surface : world.surfaces)
        planes.push_back(camera_from_world * surface.plane);
    Image<std::uint16_t> surfaces(depth.width, depth.height);
    for (std::size_t i = 0; i < surfaces.pixels.size(); ++i) {
        const int rectangle = view.rectangle.pixels[i];
        if (rectangle < 0) continue;
        const int surface = world.rectangles[static_cast<std::size_t>(rectangle)].surface;
        surfaces.pixels[i] = static_cast<std::uint16_t>(first[static_cast<std::size_t>(surface)] + 1);
    }
    return make_truth(surfaces, planes, depth, camera);
}

/// A simulated sensor with its exact truth.
Sequence open_simulated(const std::string& name, std::size_t frames) {
    const auto source =
        std::make_shared<const simulator::SimulatedSource>(simulator::parse_simulator_name(name));
    if (source->camera().depth_distortion)
        throw std::invalid_argument(name + ": its truth is a lens's here, not a pinhole's: leave out `lens`");
    const auto load = [source](std::size_t index) {
        const simulator::View view = source->biased_view(index);
        BenchFrame frame;
        frame.depth = source->frame(index).depth;
        frame.world_from_depth = view.world_from_camera;
        frame.truth =
            truth_of_view(source->world_at(source->utime(index)), view, frame.depth, source->camera());
        return frame;
    };
    return {name, source->camera(), evenly_spread(*source->size(), frames), load};
}

/// One wall, 1 to 3 m away and turned by up to 45 deg, that fills the image, without noise.
Sequence open_wall(std::size_t frames) {
    const CameraInfo camera = kinect_camera();
    const auto load = [=](std::size_t index) {
        const double k = static_cast<double>(index), angle = radians(45) * std::sin(k);
        const Eigen::Vector3d normal =
            Eigen::AngleAxisd(angle, Eigen::Vector3d(std::cos(k), std::sin(k), 0)) *
            -Eigen::Vector3d::UnitZ();
        const Plane wall{normal, -normal.z() * (1 + 0.5 * static_cast<double>(index % 5))};
        BenchFrame frame{DepthImage(camera.depth.width, camera.depth.height), {}, {}};
        for (int v = 0; v < frame.depth.height; ++v) {
            for (int u = 0; u < frame.depth.width; ++u) {
                const double z = -wall.d / normal.dot(camera.depth.unproject(u, v, 1));
                frame.depth(u, v) = static_cast<std::uint16_t>(std::lround(z * camera.depth_units_per_metre));
            }
        }
        frame.truth = make_truth(Image<std::uint16_t>(frame.depth.width, frame.depth.height, 1), {wall},
                                 frame.depth, camera);
        return frame;
    };
    return {"wall", camera, evenly_spread(frames, frames), load};
}

/// Every reading a random depth from 0.5 to 4 m of its own; nothing is true.
Sequence open_noise(std::size_t frames) {
    const CameraInfo camera = kinect_camera();
    const auto load = [=](std::size_t index) {
        BenchFrame frame{DepthImage(camera.depth.width, camera.depth.height), {}, {}};
        std::uint64_t state = index + 1;
        for (std::uint16_t& raw : frame.depth.pixels) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            raw = static_cast<std::uint16_t>(500 + (state >> 40) % 3500);
        }
        frame.truth =
            make_truth(Image<std::uint16_t>(frame.depth.width, frame.depth.height), {}, frame.depth, camera);
        return frame;
    };
    return {"noise", camera, evenly_spread(frames, frames), load};
}

}  // namespace

const std::vector<SequenceInfo>& known_sequences() {
    static const std::vector<SequenceInfo> kSequences = benchmark::with_recordings({
        {"icsl_corridor", "Xtion, hand-held, a corridor: long walls from 1 to 8 m", "", "", 55},
        {"aims_robot", "RealSense on a low robot, a classroom's floor", "", "", 80},
        {"d435_stills", "RealSense D435, single views of boxes, walls and chairs", "", "", 10},
        {"sim:office", "the simulator's room with a Kinect's noise, exact truth", "office?frames=900", "",
         60},
        {"plane_labels", "three synthetic living-room images with true labels", "", "", 3},
        {"wall", "worst case: one clean wall that fills the image", "", "", 10},
        {"noise", "worst case: every reading random", "", "", 10},
    });
    return kSequences;
}

Sequence open_sequence(const SequenceInfo& info, int frames, const std::filesystem::path& data_folder) {
    const auto count = static_cast<std::size_t>(frames > 0        ? frames
                                                : info.frames > 0 ? info.frames
                                                                  : kFrames);
    if (info.name == "wall") return open_wall(count);
    if (info.name == "noise") return open_noise(count);
    const std::string input = benchmark::input_of(info, data_folder);
    Sequence sequence = !info.simulator.empty()       ? open_simulated(input, count)
                        : info.name == "plane_labels" ? open_labelled(input, count)
                                                      : open_recording(input, count);
    sequence.name = info.name;
    return sequence;
}

std::vector<std::size_t> evenly_spread(std::size_t size, std::size_t count) {
    std::vector<std::size_t> indices;
    count = std::min(size, count);
    indices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) indices.push_back(i * size / count);
    return indices;
}

CameraInfo kinect_camera() {
    CameraInfo camera;
    camera.depth = camera.color = {640, 480, 585, 585, 319.5, 239.5};
    return camera;
}

BenchFrame render_frame(const simulator::World& world, const CameraInfo& camera,
                        const Pose& world_from_camera, bool noise, std::uint64_t seed) {
    const simulator::View view = simulator::render_view(world, camera.depth, world_from_camera);
    simulator::DepthSensorOptions options;
    options.noise = noise;
    options.max_m = camera.depth_max_m;
    const simulator::GaussianTable gaussian;
    BenchFrame frame;
    frame.depth = simulator::sense_depth(world, view, options, gaussian, seed);
    frame.world_from_depth = world_from_camera;
    frame.truth = truth_of_view(world, view, frame.depth, camera);
    return frame;
}

}  // namespace planemap::bench
