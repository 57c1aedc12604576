// SPDX-License-Identifier: BSD-3-Clause
#include "run/leaf_accuracy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

namespace planemap {
namespace {

using evaluation::JudgedReading;
using evaluation::MapFace;
using Json = nlohmann::ordered_json;

/// A plane through the origin.
MapFace face_with(const Eigen::Vector3d& normal) {
    PlanarRegion region;
    region.plane = {normal.normalized(), 0};
    region.box = {Pose::Identity(), {1, 1, 0.01}};
    region.box.frame_from_box.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), region.plane.normal).toRotationMatrix();
    region.outline = {{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}};
    return MapFace(MapPlane(3, region, 1));
}

/// Readings about the face's plane with normal noise.
std::vector<JudgedReading> readings_on(const MapFace& face, double sigma, int count) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> at(-1, 1);
    std::normal_distribution<double> noise(0, sigma);
    std::vector<JudgedReading> readings;
    for (int i = 0; i < count; ++i) {
        JudgedReading reading;
        reading.face = &face;
        reading.distance_m = noise(random);
        reading.p_world = face.world_from_plane * Eigen::Vector3d(at(random), at(random), reading.distance_m);
        reading.is_explained = reading.is_near = true;
        readings.push_back(reading);
    }
    return readings;
}

double median_of(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

TEST(LeafAccuracy, IsTheDefinitions) {
    const MapFace face = face_with({0.3, -0.5, 0.8});
    const std::vector<JudgedReading> readings = readings_on(face, 0.007, 20001);
    LeafAccuracy accuracy(nullptr);
    for (const JudgedReading& reading : readings) accuracy.add(reading);
    std::vector<double> distances;
    double squares = 0;
    for (const JudgedReading& reading : readings) {
        distances.push_back(std::abs(reading.distance_m));
        squares += reading.distance_m * reading.distance_m;
    }
    const auto figures = accuracy.figures();
    EXPECT_EQ(figures.at("readings"), 20001);
    EXPECT_NEAR(figures.at("planes").at("rms_m"), std::sqrt(squares / 20001), 1e-9);
    EXPECT_NEAR(figures.at("planes").at("median_m"), median_of(distances), 0.01 * median_of(distances));
    for (const LeafRow& row : accuracy.rows()) {
        std::vector<double> to_leaves;
        for (const JudgedReading& reading : readings) {
            double along = 0;
            for (int i = 0; i < 3; ++i) {
                const double x = reading.p_world[i];
                along +=
                    face.plane.normal[i] * (x - row.resolution_m * (std::floor(x / row.resolution_m) + 0.5));
            }
            to_leaves.push_back(std::abs(along));
        }
        EXPECT_NEAR(row.median_m, median_of(to_leaves), 0.01 * row.median_m) << row.resolution_m;
        // A leaf's extent along any direction has this standard deviation.
        EXPECT_NEAR(row.rms_m, row.resolution_m / std::sqrt(12), 0.03 * row.rms_m) << row.resolution_m;
    }
}

TEST(LeafAccuracy, LeavesThatAreAsAccurateAreFoundBetweenTheSizes) {
    const MapFace face = face_with({0.3, -0.5, 0.8});
    LeafAccuracy accuracy(nullptr);
    for (const JudgedReading& reading : readings_on(face, 0.01, 20000)) accuracy.add(reading);
    const Json figures = accuracy.figures();
    EXPECT_NEAR(figures["equal_resolution_m"]["by_rms"].get<double>(), 0.01 * std::sqrt(12), 0.002);
    EXPECT_TRUE(figures["octomap"].is_null());
    const std::vector<LeafRow> rows{{0.1, 4, 8}, {0.05, 2, 2}, {0.02, 1, 1}};
    EXPECT_DOUBLE_EQ(equal_resolution(rows, &LeafRow::rms_m, 3).value(), 0.075);
    EXPECT_DOUBLE_EQ(equal_resolution(rows, &LeafRow::rms_m, 2).value(), 0.05);
    EXPECT_DOUBLE_EQ(equal_resolution(rows, &LeafRow::rms_m, 1).value(), 0.02);
    EXPECT_DOUBLE_EQ(equal_resolution(rows, &LeafRow::median_m, 8).value(), 0.1);
    EXPECT_FALSE(equal_resolution(rows, &LeafRow::rms_m, 4.001));
    EXPECT_FALSE(equal_resolution(rows, &LeafRow::rms_m, 0.999));
    EXPECT_FALSE(equal_resolution({}, &LeafRow::rms_m, 1));
    EXPECT_FALSE(equal_resolution({{0.1, 4, 8}}, &LeafRow::rms_m, 4));
}

TEST(LeafAccuracy, WithoutReadingsNothingIsKnown) {
    LeafAccuracy accuracy(nullptr);
    JudgedReading reading;
    accuracy.add(reading);  // on no outline
    const MapFace face = face_with(Eigen::Vector3d::UnitZ());
    reading.face = &face;
    reading.distance_m = 0.06;
    reading.is_explained = true;  // by a plane that is far away, and its band wide
    accuracy.add(reading);
    const Json figures = accuracy.figures();
    EXPECT_EQ(figures["readings"], 0);
    EXPECT_TRUE(figures["planes"]["rms_m"].is_null());
    EXPECT_EQ(figures["leaves"].size(), std::size(LeafAccuracy::kResolutions_m));
    EXPECT_TRUE(figures["leaves"][0]["median_m"].is_null());
    EXPECT_TRUE(figures["equal_resolution_m"]["by_rms"].is_null());
    EXPECT_EQ(leaf_accuracy_markdown({{"accuracy_beside_size", figures}}), "");
    EXPECT_EQ(leaf_accuracy_markdown({{"accuracy_beside_size", nullptr}}), "");
    EXPECT_EQ(leaf_accuracy_markdown(Json::object()), "");
}

/// A tree with one occupied leaf, about (0.025, 0.025, 0.025), and a free one beside it.
TEST(LeafAccuracy, OfATreeTheNearestOccupiedLeafCounts) {
    ::octomap::OcTree tree(0.05);
    for (int i = 0; i < 5; ++i) tree.updateNode(::octomap::point3d(0.025f, 0.025f, 0.025f), true);
    tree.updateNode(::octomap::point3d(0.025f, 0.025f, 0.075f), false);
    const MapFace face = face_with(Eigen::Vector3d::UnitZ());
    const auto distance_of = [&](double z) {
        LeafAccuracy accuracy(&tree);
        JudgedReading reading;
        reading.face = &face;
        reading.p_world = {0.01, 0.02, z};
        reading.is_near = true;
        accuracy.add(reading);
        const Json octomap = accuracy.figures()["octomap"];
        EXPECT_EQ(octomap["readings"].get<int>() + octomap["without_leaf"].get<int>(), 1);
        return octomap["rms_m"].is_null() ? -1 : octomap["rms_m"].get<double>();
    };
    EXPECT_NEAR(distance_of(0.04), 0.015, 1e-9) << "its own";
    EXPECT_NEAR(distance_of(0.06), 0.035, 1e-9) << "its own is free";
    EXPECT_NEAR(distance_of(-0.04), 0.065, 1e-9) << "its own is not known";
    EXPECT_EQ(distance_of(0.11), -1) << "two away";
    EXPECT_EQ(distance_of(1e8), -1) << "beyond what a tree holds";
}

TEST(LeafAccuracy, TheReportSaysWhatItIs) {
    const MapFace face = face_with(Eigen::Vector3d::UnitZ());
    LeafAccuracy accuracy(nullptr);
    for (const JudgedReading& reading : readings_on(face, 0.01, 1000)) accuracy.add(reading);
    const std::string text = leaf_accuracy_markdown({{"accuracy_beside_size", accuracy.figures()}});
    EXPECT_THAT(text, testing::HasSubstr("Distances of the 1000 depth readings"));
    EXPECT_THAT(text, testing::HasSubstr("| leaves of 1.5 cm | 0.4"));
    EXPECT_THAT(text, testing::HasSubstr("by RMS, leaves of 3."));
}

}  // namespace
}  // namespace planemap
