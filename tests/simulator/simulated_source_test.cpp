// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulated_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "core/registration.hpp"
#include "simulator/planes_truth.hpp"
#include "temporary_folder.hpp"

namespace planemap::simulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(SimulatorName, IsReadStrictly) {
    const SimulatorOptions options = parse_simulator_name(
        "sim:office?frames=300&seed=7&noise=0&registered=0&units=5000&trajectory=a/b.txt");
    EXPECT_EQ(options.world, "office");
    EXPECT_EQ(options.frames, 300);
    EXPECT_EQ(options.seed, 7u);
    EXPECT_FALSE(options.noise);
    EXPECT_FALSE(options.registered);
    EXPECT_EQ(options.depth_units_per_metre, 5000);
    EXPECT_EQ(options.trajectory, "a/b.txt");
    EXPECT_EQ(parse_simulator_name("sim:office").frames, 0);
}

TEST(SimulatorName, MistakesAreNamedWithWhatThereIs) {
    const auto error = [](const char* name) { return test::error_of([&] { parse_simulator_name(name); }); };
    EXPECT_THAT(error("sim:moon"), AllOf(HasSubstr("moon"), HasSubstr("office")));
    EXPECT_THAT(error("sim:"), HasSubstr("office"));
    EXPECT_THAT(error("sim:office?colour=1"),
                AllOf(HasSubstr("colour=1"), HasSubstr("frames"), HasSubstr("seed")));
    EXPECT_THAT(error("sim:office?"), HasSubstr("frames"));
    EXPECT_THAT(error("sim:office?frames"), HasSubstr("KEY=VALUE"));
    for (const char* value : {"", "x", "1.5", "3x", " 3", "99999999999"}) {
        EXPECT_THAT(error(("sim:office?frames=" + std::string(value)).c_str()), HasSubstr("frames")) << value;
    }
    EXPECT_THAT(error("sim:office?noise=yes"), HasSubstr("0 or 1"));
    EXPECT_THAT(error("sim:office?frames=-1&rate=0&blur=17&width=5&min=nan"),
                AllOf(HasSubstr("frames"), HasSubstr("rate"), HasSubstr("blur"), HasSubstr("width"),
                      HasSubstr("min")));
    EXPECT_EQ(error("sim:office?frames=3&seed=1&frames=4"), "simulator parameter frames is given twice");
    EXPECT_THAT(error("sim:office?trajectory="), HasSubstr("trajectory is empty"));
    EXPECT_THAT(error("sim:office?units=1&max=1e9&speed=inf&seed=-1"), HasSubstr("seed is \"-1\""));
    EXPECT_THAT(error("sim:office?units=1&max=1e9&speed=inf"),
                AllOf(HasSubstr("units is 1, must be 100 to 100000"), HasSubstr("max"), HasSubstr("speed")));
    EXPECT_NE(error("office"), "");
}

SimulatorOptions small() {
    SimulatorOptions options;
    options.frames = 40;
    options.width = 160;
    options.height = 120;
    return options;
}

TEST(SimulatedSource, FramesAreTheSameInAnyOrder) {
    SimulatedSource forward(small());
    const SimulatedSource any(small());
    for (const std::size_t i : {3u, 0u, 2u, 1u}) any.frame(i);
    SensorFrame frame;
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(forward.next(frame).status, ReadResult::Status::kFrame);
        const SensorFrame same = any.frame(i);
        EXPECT_EQ(frame.utime, same.utime);
        EXPECT_EQ(frame.depth.pixels, same.depth.pixels);
        EXPECT_EQ(frame.color.pixels, same.color.pixels);
    }
}

TEST(SimulatedSource, AnotherSeedIsAnotherWalkInAnotherPaint) {
    SimulatorOptions other = small();
    other.seed = 2;
    const SimulatedSource a(small()), b(other);
    EXPECT_NE(a.world_from_color(a.utime(9)).matrix(), b.world_from_color(b.utime(9)).matrix());
    EXPECT_NE(a.frame(0).color.pixels, b.frame(0).color.pixels);
}

TEST(SimulatedSource, PosesAndPlanesAgreeWithTheDepth) {
    for (const bool registered : {true, false}) {
        SimulatorOptions options = small();
        options.noise = false;
        options.registered = registered;
        options.depth_units_per_metre = 5000;
        const SimulatedSource source(options);
        const CameraInfo& camera = source.camera();
        const SensorFrame frame = source.frame(20);
        const View view = source.depth_view(20);
        const Pose world_from_depth = source.world_from_color(frame.utime) * camera.color_from_depth;
        int checked = 0;
        for (int v = 0; v < frame.depth.height; ++v) {
            for (int u = 0; u < frame.depth.width; ++u) {
                const std::uint16_t raw = frame.depth(u, v);
                if (!is_valid_depth(raw)) continue;
                const auto& rectangle =
                    source.world().rectangles[static_cast<std::size_t>(view.rectangle(u, v))];
                const Plane& plane =
                    source.world().surfaces[static_cast<std::size_t>(rectangle.surface)].plane;
                const auto p = world_from_depth * camera.depth.unproject(u, v, camera.metres(raw));
                EXPECT_NEAR(plane.signed_distance(p), 0, 2e-4);
                ++checked;
            }
        }
        EXPECT_GT(checked, 10000);
    }
}

TEST(SimulatedSource, UnregisteredDepthRegistersToTheRegisteredOne) {
    SimulatorOptions options = small();
    options.noise = false;
    const SimulatedSource registered(options);
    options.registered = false;
    const SimulatedSource raw(options);
    EXPECT_FALSE(raw.camera().registered);
    const DepthImage expected = registered.frame(10).depth;
    const DepthImage moved = register_depth(raw.frame(10).depth, raw.camera());
    int near = 0, both = 0;
    for (std::size_t i = 0; i < moved.pixels.size(); ++i) {
        if (!is_valid_depth(moved.pixels[i]) || !is_valid_depth(expected.pixels[i])) continue;
        ++both;
        near += std::abs(moved.pixels[i] - expected.pixels[i]) <= 30 ? 1 : 0;
    }
    EXPECT_GT(both, 8000);
    EXPECT_GT(near, 0.95 * both);
}

TEST(SimulatedSource, OptionsChangeWhatTheyShould) {
    SimulatorOptions options = small();
    options.noise = false;
    const SimulatedSource plain(options);
    options.blur_samples = 6;
    const SensorFrame blurred = SimulatedSource(options).frame(30);
    EXPECT_EQ(blurred.depth.pixels, plain.frame(30).depth.pixels);
    EXPECT_NE(blurred.color.pixels, plain.frame(30).color.pixels);
    options.blur_samples = 1;
    options.color_jitter_s = 0.01;
    const SimulatedSource jittered(options);
    EXPECT_NE(jittered.color_utime(5), jittered.utime(5));
    EXPECT_LE(std::abs(jittered.color_utime(5) - jittered.utime(5)), 10000);
    EXPECT_EQ(plain.color_utime(5), plain.utime(5));
    options.color_jitter_s = 0;
    options.exposure_drift = 0.4;
    EXPECT_NE(SimulatedSource(options).frame(30).color.pixels, plain.frame(30).color.pixels);
}

TEST(SimulatedSource, ARecordedTrajectoryIsFollowed) {
    const test::TemporaryFolder folder;
    const auto file = folder.write(
        "path.txt", "1.0 0 -1.4 0 0 0 0 1\n1.5 0.2 -1.4 0.1 0 0.05 0 1\n2.0 0.4 -1.4 0.2 0 0.1 0 1\n");
    SimulatorOptions options = small();
    options.frames = 0;
    options.trajectory = file.string();
    const SimulatedSource source(options);
    EXPECT_EQ(source.size(), 31u);
    const Pose moved = source.world_from_color(1000000).inverse() * source.world_from_color(2000000);
    EXPECT_NEAR((moved.translation() - Eigen::Vector3d(0.4, 0, 0.2)).norm(), 0, 1e-9);
    options.frames = 32;
    EXPECT_THAT(test::error_of([&] { SimulatedSource{options}; }), HasSubstr("31"));
    options.trajectory = folder.write("empty.txt", "").string();
    EXPECT_THAT(test::error_of([&] { SimulatedSource{options}; }), HasSubstr("no poses"));
    options.trajectory = "/nonexistent/poses.txt";
    EXPECT_THAT(test::error_of([&] { SimulatedSource{options}; }), HasSubstr("/nonexistent/poses.txt"));
}

TEST(SimulatedSource, TruthIsWritten) {
    const SimulatedSource source(small());
    const test::TemporaryFolder folder;
    write_trajectory(folder.path() / "groundtruth.txt", source.ground_truth());
    const Trajectory truth = read_trajectory(folder.path() / "groundtruth.txt");
    ASSERT_EQ(truth.size(), 40u);
    EXPECT_EQ(truth[7].utime, source.utime(7));
    EXPECT_LT(
        (truth[7].world_from_camera.matrix() - source.world_from_color(source.utime(7)).matrix()).norm(),
        1e-6);

    write_planes_truth(folder.path() / "planes_truth.json", source);
    const auto document = nlohmann::json::parse(read_file(folder.path() / "planes_truth.json"));
    ASSERT_EQ(document["planes"].size(), source.world().surfaces.size());
    for (const auto& plane : document["planes"]) {
        const Eigen::Vector3d normal(plane["normal"][0], plane["normal"][1], plane["normal"][2]);
        ASSERT_FALSE(plane["rectangles"].empty());
        for (const auto& corner : plane["rectangles"][0]) {
            const Eigen::Vector3d p(corner[0], corner[1], corner[2]);
            EXPECT_NEAR(normal.dot(p) + plane["d"].get<double>(), 0, 1e-9);
        }
        EXPECT_GT(plane["area"].get<double>(), 0);
    }
}

}  // namespace
}  // namespace planemap::simulator
