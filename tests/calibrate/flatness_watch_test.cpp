// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/flatness_watch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/offset_at.hpp"

namespace planemap {
namespace {

using graph::Flatness;

CameraInfo sensor() {
    CameraInfo camera;
    camera.depth = camera.color = {320, 240, 290, 290, 159.5, 119.5};
    camera.depth_units_per_metre = 10000;
    return camera;
}

/// What a sensor reads of a plane that fills its image when true inverse depth = sensed + field.
DepthImage wall(const CameraInfo& camera, const Plane& plane, const DepthCorrection& field) {
    DepthImage depth(camera.depth.width, camera.depth.height);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const double inverse = -plane.normal.dot(camera.depth.unproject(u, v, 1)) / plane.d;
            const double sensed = 1 / (inverse - test::offset_at(field, camera.depth, u, v));
            depth(u, v) = static_cast<std::uint16_t>(std::lround(sensed * camera.depth_units_per_metre));
        }
    }
    return depth;
}

Flatness flatness_of(const DepthCorrection& field) {
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus);
    FlatnessWatch watch(decoder);
    const CameraInfo camera = sensor();
    const Image<std::uint16_t> all(camera.depth.width, camera.depth.height, 1);
    for (const double tilt : {-0.3, 0.0, 0.4}) {
        const Eigen::Vector3d normal = Eigen::Vector3d(tilt, 0.2, -1).normalized();
        watch.add(wall(camera, {normal, 1.5 + tilt}, field), all, camera);
    }
    return watch.flatness();
}

/// A field less what is linear over the image, which turns one plane into another.
Flatness::Field bent_part(const Flatness::Field& field) {
    Eigen::Matrix<double, DepthCorrection::kNodes, 3> linear;
    for (int i = 0; i < linear.rows(); ++i) {
        constexpr int kColumns = static_cast<int>(DepthCorrection::kColumns);
        const int row = i / kColumns, column = i % kColumns;
        linear.row(i) << 1, column, row;
    }
    return field - linear * linear.colPivHouseholderQr().solve(field);
}

TEST(FlatnessWatch, SeesHowAWallIsBentInItself) {
    DepthCorrection field;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        field.offsets[i] = 0.001 * std::sin(1.7 * static_cast<double>(i)) + 0.002;
    const Flatness flatness = flatness_of(field);
    EXPECT_EQ(flatness.regions, 3);
    const Flatness::Field found = flatness.information.completeOrthogonalDecomposition().solve(flatness.pull);
    const Flatness::Field truth = Eigen::Map<const Flatness::Field>(field.offsets.data());
    EXPECT_LT((bent_part(found) - bent_part(truth)).cwiseAbs().maxCoeff(), 5e-5);
    EXPECT_GT(bent_part(truth).cwiseAbs().maxCoeff(), 5e-4);
}

TEST(FlatnessWatch, SaysNothingOfFieldsThatTurnAPlaneIntoAnother) {
    const Flatness flatness = flatness_of({});
    DepthCorrection linear;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        linear.offsets[i] = 1 + 0.5 * static_cast<double>(i % DepthCorrection::kColumns);
    const Flatness::Field field = Eigen::Map<const Flatness::Field>(linear.offsets.data());
    EXPECT_LT(field.dot(flatness.information * field), 1e-4 * flatness.information.trace());
}

TEST(FlatnessWatch, LeavesOutSmallRegionsAndReadingsWithoutOne) {
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus);
    FlatnessWatch watch(decoder);
    const CameraInfo camera = sensor();
    const DepthImage depth = wall(camera, {{0, 0, -1}, 2}, {});
    Image<std::uint16_t> labels(camera.depth.width, camera.depth.height);
    watch.add(depth, labels, camera);
    for (int v = 0; v < 20; ++v)
        for (int u = 0; u < 20; ++u) labels(u, v) = 65535;
    watch.add(depth, labels, camera);
    watch.add(DepthImage(camera.depth.width, camera.depth.height), labels, camera);
    EXPECT_EQ(watch.flatness().regions, 0);
    EXPECT_EQ(watch.flatness().information.norm(), 0);
}

}  // namespace
}  // namespace planemap
