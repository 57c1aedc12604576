// SPDX-License-Identifier: BSD-3-Clause
#include "core/camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

CameraInfo kinect() {
    CameraInfo info;
    info.serial = "test";
    info.depth = info.color = {640, 480, 525, 530, 319.5, 239.5};
    return info;
}

std::string error_of(const CameraInfo& info) {
    try {
        info.validate();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Camera, ProjectInvertsUnproject) {
    test::Random random(1);
    const PinholeCamera camera = kinect().depth;
    for (int i = 0; i < 100; ++i) {
        const double u = random.uniform(0, 639), v = random.uniform(0, 479), z = random.uniform(0.3, 8);
        const Eigen::Vector3d p = camera.unproject(u, v, z);
        EXPECT_EQ(p.z(), z);
        EXPECT_TRUE(camera.project(p).isApprox(Eigen::Vector2d(u, v), 1e-12));
    }
    EXPECT_TRUE(camera.unproject(319.5, 239.5, 2).isApprox(Eigen::Vector3d(0, 0, 2)));
}

TEST(Camera, SeesExactlyThePixelsOfTheImage) {
    const PinholeCamera camera = kinect().depth;
    EXPECT_TRUE(camera.sees({0, 0}));
    EXPECT_TRUE(camera.sees({-0.5, 479.49}));
    EXPECT_FALSE(camera.sees({-0.51, 10}));
    EXPECT_FALSE(camera.sees({639.5, 10}));
    EXPECT_FALSE(camera.sees({10, 479.5}));
    EXPECT_FALSE(camera.sees({std::numeric_limits<double>::quiet_NaN(), 10}));
}

TEST(Camera, NoiseGrowsWithTheSquareOfDepth) {
    const DepthNoise noise;
    EXPECT_NEAR(noise.sigma(0.4), 0.0012, 1e-12);
    EXPECT_NEAR(noise.sigma(2.4), 0.0012 + 0.0019 * 4, 1e-12);
}

TEST(Camera, MetresFollowTheSensorsUnit) {
    CameraInfo info = kinect();
    EXPECT_DOUBLE_EQ(info.metres(1500), 1.5);
    info.depth_units_per_metre = 5000;
    EXPECT_DOUBLE_EQ(info.metres(1500), 0.3);
}

TEST(Camera, ValidateAcceptsAKinectAndNamesEveryBadField) {
    EXPECT_EQ(error_of(kinect()), "");
    CameraInfo bad = kinect();
    bad.depth.width = 0;
    bad.color.height = 100000;
    bad.color.fx = std::numeric_limits<double>::quiet_NaN();
    bad.depth.fy = -1;
    bad.depth.cx = std::numeric_limits<double>::infinity();
    bad.depth_units_per_metre = 0;
    bad.depth_min_m = -1;
    bad.depth_max_m = -2;
    bad.noise.base_m = -1;
    bad.color_from_depth.linear().setZero();
    bad.serial.assign(65, 'x');
    const std::string error = error_of(bad);
    for (const char* field :
         {"depth.width", "color.height", "color.fx", "depth.fy", "depth.cx", "depth_units_per_metre",
          "depth_min_m", "depth_max_m", "noise.base_m", "color_from_depth", "serial"}) {
        EXPECT_THAT(error, HasSubstr(field));
    }
    EXPECT_NE(error_of(CameraInfo{}), "");
}

TEST(Camera, EqualityComparesEveryField) {
    const CameraInfo a = kinect();
    EXPECT_TRUE(a == kinect());
    CameraInfo b = a;
    b.color_from_depth.translation().x() = 0.02;
    EXPECT_FALSE(a == b);
    b = a;
    b.noise.offset_m = 0.5;
    EXPECT_FALSE(a == b);
}

TEST(Camera, ResolutionsTooFarApartAreRefusedWithBothFocalLengths) {
    for (const double ratio : {0.3, 0.62, 1.0, 4.0}) {
        CameraInfo info = kinect();
        info.depth.fx *= ratio;
        info.depth.fy *= ratio;
        EXPECT_EQ(error_of(info), "") << ratio;
    }
    CameraInfo info = kinect();
    info.color.fx = 2100;  // depth's 525 is a quarter
    info.color.fy = 1060;
    EXPECT_THAT(error_of(info),
                HasSubstr("depth.fx / color.fx is 0.25 (525 / 2100 pixels), must be 0.3 to 4"));
    EXPECT_EQ(error_of(info).find("fy"), std::string::npos);
    info = kinect();
    info.color.fy = 100;
    EXPECT_THAT(error_of(info), HasSubstr("depth.fy / color.fy is 5.3 (530 / 100 pixels), must be 0.3 to 4"));
}

TEST(Camera, NumbersThatNoCameraHasAreRefused) {
    const auto with = [](const auto& change) {
        CameraInfo info = kinect();
        change(info);
        return error_of(info);
    };
    EXPECT_THAT(with([](auto& c) { c.depth.fx = c.color.fx = 260; }),
                HasSubstr("depth.fx / depth.fy is 0.490566 (260 / 530 pixels), must be 0.5 to 2"));
    EXPECT_THAT(with([](auto& c) { c.color.fx = c.color.fy = 100; }),
                HasSubstr("color.fx is 100, must be 128 to 6400 pixels"));
    EXPECT_THAT(with([](auto& c) { c.depth.cx = 3195; }), HasSubstr("depth.cx is 3195, must be -320 to 960"));
    EXPECT_THAT(with([](auto& c) { c.depth_units_per_metre = 1; }), HasSubstr("depth_units_per_metre is 1"));
    EXPECT_THAT(
        with([](auto& c) { c.depth_min_m = 70, c.depth_max_m = 80; }),
        HasSubstr("depth_units_per_metre is 1000, must be such that 16 bits reach beyond depth_min_m"));
    EXPECT_THAT(with([](auto& c) { c.noise = {0, 0, 0}; }), HasSubstr("noise at 0.3 m is 0"));
    EXPECT_THAT(with([](auto& c) { c.noise = {1e-3, 0.9, -9}; }), HasSubstr("at most its far end"));
    EXPECT_EQ(with([](auto& c) { c.noise = {0, 0.001, 0}; }), "");
}

}  // namespace
}  // namespace planemap
