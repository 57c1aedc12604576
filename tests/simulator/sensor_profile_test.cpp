// SPDX-License-Identifier: BSD-3-Clause
// What each kind of sensor does, one thing at a time.
#include "simulator/sensor_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/sensor_preset.hpp"
#include "core/undistortion.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

const PinholeCamera kCamera{320, 240, 262, 262, 159.5, 119.5};
const Look kBrick{Pattern::kBrick, {0.6f, 0.4f, 0.3f}};

World wall_at(double distance, const Look& look = kBrick) {
    WorldBuilder builder("wall", 1, 4);
    builder.add_panel("wall", {-8, -6, distance}, Vector3d::UnitX(), Vector3d::UnitY(), 16, 12, look);
    return builder.world();
}

/// A board 1 m wide at 1.5 m before a wall at 3 m.
World board_before_wall() {
    WorldBuilder builder("board", 1, 4);
    builder.add_panel("wall", {-8, -6, 3}, Vector3d::UnitX(), Vector3d::UnitY(), 16, 12, kBrick);
    builder.add_panel("board", {-0.5, -3, 1.5}, Vector3d::UnitX(), Vector3d::UnitY(), 1, 6, kBrick);
    return builder.world();
}

DepthSensorOptions options_of_kind(Principle principle) {
    DepthSensorOptions options;
    options.principle = principle;
    options.max_m = 6;
    options.units_per_metre = 10000;
    options.baseline_m = 0.05;
    return options;
}

DepthImage sense(const World& world, const DepthSensorOptions& options, std::uint64_t seed = 1) {
    static const GaussianTable kGaussian;
    return sense_depth(world, render_view(world, kCamera, Pose::Identity()), options, kGaussian, seed);
}

SimulatedSource source(const std::string& parameters, const std::string& size = "width=320&height=240") {
    return SimulatedSource(parse_simulator_name("sim:office?frames=30&" + size + parameters));
}
const std::string kSmall = "width=160&height=120";  // coarse textures: made in no time

/// Root mean square of a specimen's error at a range.
double error_at(const DepthBias& bias, double z) {
    double squares = 0;
    for (int v = 0; v < kCamera.height; ++v) {
        for (int u = 0; u < kCamera.width; ++u) squares += std::pow(bias.read(u, v, z) - z, 2);
    }
    return std::sqrt(squares / (kCamera.width * kCamera.height));
}

TEST(DepthBias, GrowsWithRangeToWhatWasAskedFor) {
    for (const std::uint64_t specimen : {1u, 2u, 3u, 4u}) {
        const DepthBias triangulation(Principle::kStructuredLight, 0.03, kCamera, specimen);
        EXPECT_NEAR(error_at(triangulation, 4), 0.12, 0.01);
        EXPECT_NEAR(error_at(triangulation, 4) / error_at(triangulation, 2), 4, 0.3);
        EXPECT_NEAR(error_at(triangulation, 2) / error_at(triangulation, 1), 4, 0.2);
        const DepthBias flight(Principle::kLidar, 0.004, kCamera, specimen);
        EXPECT_NEAR(error_at(flight, 4), 0.016, 0.001);
        EXPECT_NEAR(error_at(flight, 4) / error_at(flight, 2), 2, 0.01);
        const DepthBias phases(Principle::kTimeOfFlight, 0.004, kCamera, specimen);
        EXPECT_NEAR(error_at(phases, 4), 0.016, 0.004);
    }
}

TEST(DepthBias, IsSmoothAndOfOneSpecimen) {
    const DepthBias bias(Principle::kStereo, 0.03, kCamera, 5), same(Principle::kStereo, 0.03, kCamera, 5),
        other(Principle::kStereo, 0.03, kCamera, 6);
    double most_apart = 0;
    for (int v = 1; v < kCamera.height; ++v) {
        for (int u = 1; u < kCamera.width; ++u) {
            const double here = bias.read(u, v, 4);
            EXPECT_EQ(here, same.read(u, v, 4));
            EXPECT_NEAR(here, bias.read(u - 1, v, 4), 0.012);
            EXPECT_NEAR(here, bias.read(u, v - 1, 4), 0.012);
            most_apart = std::max(most_apart, std::abs(here - other.read(u, v, 4)));
        }
    }
    EXPECT_GT(most_apart, 0.05);
}

TEST(DepthBias, IsInTheFramesAndNotWithoutIt) {
    const SimulatedSource plain = source("&noise=0"), bent = source("&noise=0&bias=0.03");
    EXPECT_FALSE(plain.bias());
    EXPECT_EQ(plain.biased_view(3).inverse_depth.pixels, plain.depth_view(3).inverse_depth.pixels);
    EXPECT_EQ(plain.true_cameras().depth, plain.camera().depth);
    EXPECT_EQ(plain.true_cameras().color, plain.camera().color);
    const View view = bent.depth_view(3);
    const SensorFrame frame = bent.frame(3);
    EXPECT_EQ(frame.color.pixels, plain.frame(3).color.pixels);
    int checked = 0;
    for (int v = 0; v < 240; v += 7) {
        for (int u = 0; u < 320; u += 7) {
            if (!is_valid_depth(frame.depth(u, v))) continue;
            EXPECT_NEAR(bent.camera().metres(frame.depth(u, v)), bent.bias()->read(u, v, view.depth(u, v)),
                        6e-4);
            ++checked;
        }
    }
    EXPECT_GT(checked, 1000);
}

TEST(Profiles, HaveThePublishedNoise) {
    for (const SensorProfile& profile : sensor_profiles()) {
        const SensorPreset* preset = find_sensor_preset(profile.name);
        ASSERT_NE(preset, nullptr) << profile.name;
        const SimulatorOptions simulated = parse_simulator_name(
            "sim:office?width=320&height=240&units=10000&min=0.3&max=6&holes=0&profile=" + profile.name);
        const CameraInfo camera = nominal_camera(simulated);
        const DepthSensorOptions options = depth_options(simulated, camera);
        const GaussianTable gaussian;
        for (const double z : {0.9, 1.5, 2.0, 3.0}) {
            const World wall = wall_at(z);
            const DepthImage depth =
                sense_depth(wall, render_view(wall, camera.depth, Pose::Identity()), options, gaussian, 1);
            double sum = 0, squares = 0, count = 0;
            for (const std::uint16_t raw : depth.pixels) {
                if (!is_valid_depth(raw)) continue;
                const double error = raw / options.units_per_metre - z;
                sum += error, squares += error * error, ++count;
            }
            const double sigma = preset->noise.sigma(z);
            EXPECT_GT(count, 0.95 * static_cast<double>(depth.pixels.size())) << profile.name;
            EXPECT_NEAR(std::sqrt(squares / count - sum * sum / count / count), sigma, 0.15 * sigma)
                << profile.name << " at " << z;
            EXPECT_NEAR(sum / count, 0, 0.3 * sigma) << profile.name << " at " << z;
        }
    }
}

TEST(Profiles, SayWhatTheyAreAndYieldToWhatIsSaidBeside) {
    for (const SensorProfile& profile : sensor_profiles()) {
        const SimulatedSource whole(parse_simulator_name("sim:clutter?frames=2&profile=" + profile.name));
        const SensorPreset& preset = *find_sensor_preset(profile.name);
        EXPECT_EQ(whole.camera().noise, preset.noise);
        EXPECT_EQ(whole.camera().depth_max_m, preset.depth_max_m);
        EXPECT_EQ(whole.camera().depth, profile.registered ? profile.color : profile.depth);
        EXPECT_EQ(whole.camera().color, profile.color);
        EXPECT_THAT(whole.camera().serial, HasSubstr(profile.name));
        const SensorFrame frame = whole.frame(1);
        EXPECT_EQ(frame.depth.width, whole.camera().depth.width);
        EXPECT_EQ(frame.color.height, whole.camera().color.height);
    }
    // In any order.
    for (const char* name : {"sim:office?profile=kinect1&width=320&height=240&bias=0&max=4&specimen=7",
                             "sim:office?specimen=7&max=4&bias=0&height=240&width=320&profile=kinect1"}) {
        const SimulatorOptions options = parse_simulator_name(name);
        EXPECT_EQ(options.width, 320);
        EXPECT_EQ(options.bias, 0);
        EXPECT_EQ(options.depth_max_m, 4);
        EXPECT_EQ(options.specimen, 7u);
        EXPECT_GT(options.focal_error, 0);
        EXPECT_EQ(nominal_camera(options).color.fx, 262.5);
    }
    const auto error = [](const char* name) { return test::error_of([&] { parse_simulator_name(name); }); };
    EXPECT_THAT(error("sim:office?profile=kinect7"),
                AllOf(HasSubstr("kinect7"), HasSubstr("kinect1"), HasSubstr("d435")));
    EXPECT_THAT(error("sim:office?profile="), HasSubstr("profile is empty"));
    EXPECT_THAT(error("sim:office?bias=1&multipath=-1"), AllOf(HasSubstr("bias"), HasSubstr("multipath")));
}

TEST(Profiles, TheSameNameGivesTheSameBytes) {
    for (const SensorProfile& profile : sensor_profiles()) {
        const std::string name = "&profile=" + profile.name;
        const SimulatedSource a = source(name, kSmall), b = source(name, kSmall),
                              other = source(name + "&specimen=2", kSmall);
        b.frame(2);
        const SensorFrame frame = a.frame(9), same = b.frame(9);
        EXPECT_EQ(frame.depth.pixels, same.depth.pixels) << profile.name;
        EXPECT_EQ(frame.color.pixels, same.color.pixels) << profile.name;
        EXPECT_NE(frame.depth.pixels, other.frame(9).depth.pixels) << profile.name;
    }
}

TEST(Profiles, WithoutTheirErrorsAreExact) {
    const std::string none = "&noise=0&bias=0&focal_error=0&mount_error=0&distortion=0&multipath=0";
    for (const SensorProfile& profile : sensor_profiles()) {
        const SimulatedSource exact = source("&profile=" + profile.name + none, kSmall);
        EXPECT_EQ(exact.true_cameras().depth, exact.camera().depth);
        EXPECT_EQ(exact.true_cameras().color_from_depth.matrix(), exact.camera().color_from_depth.matrix());
        const View view = exact.depth_view(9);
        const DepthImage depth = exact.frame(9).depth;
        for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
            if (!is_valid_depth(depth.pixels[i])) continue;
            ASSERT_NEAR(depth.pixels[i], 1000 / view.inverse_depth.pixels[i], 0.51) << profile.name;
        }
    }
}

TEST(TrueCameras, MissTheNominalOnesByWhatIsSaid) {
    CameraInfo nominal;
    nominal.depth = nominal.color = kCamera;
    for (const std::uint64_t specimen : {1u, 2u, 3u, 4u, 5u}) {
        const TrueCameras cameras = true_cameras(nominal, 0.01, 0.5, specimen);
        EXPECT_NEAR(std::abs(cameras.color.fx / kCamera.fx - 1), 0.01, 1e-9);
        EXPECT_EQ(cameras.depth, cameras.color) << "registered: one image";
        EXPECT_NEAR(degrees(rotation_angle(cameras.color_from_depth)), 0.5, 1e-6);
        EXPECT_NEAR(cameras.color_from_depth.translation().norm(), 0.0025, 1e-9);
    }
}

TEST(Lens, ReadsEachPixelsOwnRay) {
    const World office = make_office(1, 8);
    const SimulatedSource bent = source("&noise=0&distortion=0.03");
    const Lens lens(bent.true_cameras().depth, 0.03);
    EXPECT_NEAR((lens.ideal(0, 0) - Eigen::Vector2d(159.5, 119.5)).norm(), 0.97 * std::hypot(159.5, 119.5),
                1e-9);
    const View view = bent.biased_view(9);
    int checked = 0, crossed = 0;
    for (int v = 0; v < 240; v += 5) {
        for (int u = 0; u < 320; u += 5) {
            const std::int16_t index = view.rectangle(u, v);
            ASSERT_GE(index, 0);
            const Rectangle& r = bent.world().rectangles[static_cast<std::size_t>(index)];
            const Eigen::Vector2d pixel = lens.ideal(u, v);
            const Vector3d p =
                view.world_from_camera * view.camera.unproject(pixel.x(), pixel.y(), view.depth(u, v));
            EXPECT_NEAR(bent.world().surfaces[static_cast<std::size_t>(r.surface)].plane.signed_distance(p),
                        0, 1e-4);
            crossed += (r.nearest(p) - p).norm() > 0.02 ? 1 : 0;
            ++checked;
        }
    }
    EXPECT_GT(checked, 3000);
    EXPECT_LT(crossed, 0.01 * checked) << "rectangles end where they end";
    EXPECT_NE(bent.frame(9).color.pixels, source("&noise=0").frame(9).color.pixels);
    const LaneImage even(320, 240, 4000 | 100ull << 32);
    EXPECT_EQ(lens.distorted(even).pixels, even.pixels);
}

TEST(Lens, OfAModelIsUndoneByIt) {
    for (const std::string lens : {"brown:-0.28,0.07,0.001,-0.002", "brown:0.35,0,0,0", "fisheye:0,0,0,0"}) {
        const SimulatedSource exact = source("&noise=0"), bent = source("&noise=0&lens=" + lens);
        EXPECT_EQ(bent.camera().depth_distortion, parse_lens(lens));
        EXPECT_EQ(bent.camera().color_distortion, parse_lens(lens));
        EXPECT_FALSE(source("&lens_told=0&lens=" + lens).camera().depth_distortion);
        EXPECT_EQ(source("&noise=0&lens_told=0&lens=" + lens).frame(9).depth.pixels,
                  bent.frame(9).depth.pixels);
        const SensorFrame truth = exact.frame(9);
        SensorFrame frame = bent.frame(9);
        ASSERT_EQ(frame.depth.width, truth.depth.width);
        int before = 0, after = 0, seen = 0;
        const auto count = [&](int& near) {
            for (std::size_t i = 0; i < frame.depth.pixels.size(); ++i) {
                const int a = frame.depth.pixels[i], b = truth.depth.pixels[i];
                near += a != 0 && b != 0 && std::abs(a - b) < 15 ? 1 : 0;
            }
        };
        count(before);
        const Undistortion undistortion(bent.camera());
        undistortion.undistort(frame.depth);
        undistortion.undistort(frame.color);
        count(after);
        double off = 0;
        for (std::size_t i = 0; i < frame.depth.pixels.size(); ++i) {
            if (frame.depth.pixels[i] == 0 || truth.depth.pixels[i] == 0) continue;
            off += std::abs(frame.color.pixels[i].g - truth.color.pixels[i].g);
            ++seen;
        }
        EXPECT_GT(after, 0.97 * seen) << lens;
        EXPECT_LT(before, 0.95 * seen) << lens;
        EXPECT_LT(off / seen, 3) << lens;
    }
}

TEST(Lens, ThatCannotBeIsRefused) {
    for (const std::string lens : {"brown", "brown:", "brown:1,2", "brown:0,x,0,0", "brown:0,0,0,0,",
                                   "pinhole:0", "brown:-0.9,0,0,0", "brown:nan,0,0,0"}) {
        EXPECT_THROW(source("&lens=" + lens), std::invalid_argument) << lens;
        EXPECT_THROW(source("&lens_told=0&lens=" + lens), std::invalid_argument) << lens;
    }
}

TEST(Multipath, MakesCornersTooDeepAndLeavesAWall) {
    WorldBuilder builder("corner", 1, 8);
    const double s = std::sqrt(0.5);
    builder.add_panel("left", {-3, -1.5, 0}, {s, 0, s}, Vector3d::UnitY(), 3 / s, 3, kBrick);
    builder.add_panel("right", {0, -1.5, 3}, {s, 0, -s}, Vector3d::UnitY(), 3 / s, 3, kBrick);
    const World corner = builder.world();
    const View exact = render_view(corner, kCamera, Pose::Identity());
    View view = exact;
    add_multipath(corner, view, 1);
    const auto excess = [&](int u) { return view.depth(u, 120) - exact.depth(u, 120); };
    EXPECT_GT(excess(152), 0.01);
    EXPECT_LT(excess(152), 0.15);
    EXPECT_GT(excess(152), 1.5 * excess(40));
    for (int u = 0; u < 320; ++u) EXPECT_LT(std::abs(excess(u)), 0.1) << u;
    View half = exact;
    add_multipath(corner, half, 0.5);
    EXPECT_LT(half.depth(152, 120), view.depth(152, 120));

    const World wall = wall_at(2);
    View flat = render_view(wall, kCamera, Pose::Identity());
    const auto before = flat.inverse_depth.pixels;
    add_multipath(wall, flat, 1);
    EXPECT_EQ(flat.inverse_depth.pixels, before);
}

/// Readings of a row that are on neither the board nor the wall, those of the board, and those missing.
struct EdgeCount {
    int between = 0, board = 0, missing = 0;
};
EdgeCount at_edges(const DepthSensorOptions& options) {
    const DepthImage depth = sense(board_before_wall(), options);
    EdgeCount count;
    for (const std::uint16_t raw : depth.pixels) {
        const double z = raw / options.units_per_metre;
        count.missing += raw == 0 ? 1 : 0;
        count.board += std::abs(z - 1.5) < 0.03 ? 1 : 0;
        count.between += z > 1.6 && z < 2.8 ? 1 : 0;
    }
    return count;
}

TEST(Edges, EachKindHasItsOwnFaults) {
    DepthSensorOptions options = options_of_kind(Principle::kTimeOfFlight);
    options.holes = false;
    options.edges = false;
    const EdgeCount clean = at_edges(options);
    EXPECT_EQ(clean.between, 0);
    EXPECT_EQ(clean.missing, 0);
    EXPECT_NEAR(clean.board, 262 / 1.5 * 240, 500);
    options.edges = true;
    const EdgeCount flight = at_edges(options);
    EXPECT_GT(flight.between, 200) << "flying pixels";
    EXPECT_GT(flight.missing, 100);

    options.principle = Principle::kStereo;
    const EdgeCount stereo = at_edges(options);
    EXPECT_EQ(stereo.between, 0);
    EXPECT_GT(stereo.board, clean.board + 120) << "it bleeds";
    // f b (1 / 1.5 - 1 / 3) = 4.4 pixels beside the board, less what bleeds over it.
    EXPECT_NEAR(stereo.missing, 4.4 * 240, 500);

    options.principle = Principle::kLidar;
    const EdgeCount lidar = at_edges(options);
    EXPECT_GT(lidar.between, 400) << "smeared";
    EXPECT_EQ(lidar.missing, 0);
}

TEST(Holes, StereoLosesBareWallsFarAway) {
    const DepthSensorOptions options = options_of_kind(Principle::kStereo);
    const auto lost = [&](double z, const Look& look) {
        const DepthImage depth = sense(wall_at(z, look), options);
        return static_cast<double>(std::count(depth.pixels.begin(), depth.pixels.end(), 0)) /
               static_cast<double>(depth.pixels.size());
    };
    const Look paint{Pattern::kPaint, {0.86f, 0.85f, 0.81f}};
    EXPECT_LT(lost(2, paint), 0.01);
    EXPECT_GT(lost(4, paint), 0.2);
    EXPECT_LT(lost(4, paint), 0.9);
    EXPECT_LT(lost(4, {Pattern::kTiles, {0.6f, 0.6f, 0.6f}}), 0.5 * lost(4, paint));
    DepthSensorOptions without = options;
    without.holes = false;
    const DepthImage whole = sense(wall_at(4, paint), without);
    EXPECT_EQ(std::count(whole.pixels.begin(), whole.pixels.end(), 0), 0);
}

TEST(SimulatorParameters, SigmaScalesTheNoiseAlone) {
    const DepthImage quiet =
        source("&sigma=0&edges=0&holes=0&profile=azure_kinect&bias=0&multipath=0").frame(3).depth;
    const SimulatedSource exact = source("&noise=0&profile=azure_kinect&bias=0&multipath=0");
    EXPECT_EQ(quiet.pixels, exact.frame(3).depth.pixels);
}

}  // namespace
}  // namespace planemap::simulator
