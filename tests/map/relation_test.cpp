// SPDX-License-Identifier: BSD-3-Clause
#include "map/relation.hpp"

#include <gtest/gtest.h>

#include "core/furniture.hpp"
#include "core/geometry/plane_intersection.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::kDegree;
using scene::level;
using scene::upright;

constexpr double kPi = std::numbers::pi;

PlaneRelation between(const PlaneMap& map, std::size_t a, std::size_t b) {
    return relation(map.planes[a], map.planes[b]);
}

TEST(Relation, OfParallelAndOfOtherPlanes) {
    const PlaneMap map = scene::map_of({upright(0, 0, 0, 0, 4, 2), upright(3, 1, 0, kPi, 2, 2),
                                        upright(2, 0, 0, 5 * kDegree, 1, 2),
                                        upright(2, 3, 0, 56 * kDegree, 1, 2), level(0, 0, 0, 2, 2)});
    EXPECT_NEAR(between(map, 0, 1).angle, kPi, 1e-6);
    EXPECT_NEAR(between(map, 0, 1).distance.value(), 3, 1e-6);
    EXPECT_NEAR(between(map, 0, 2).angle, 5 * kDegree, 1e-6);
    EXPECT_NEAR(between(map, 0, 2).distance.value(), 2, 0.01);
    EXPECT_NEAR(between(map, 0, 3).angle, 56 * kDegree, 1e-6);
    EXPECT_FALSE(between(map, 0, 3).distance);
    EXPECT_NEAR(between(map, 0, 4).angle, kPi / 2, 1e-6);
}

TEST(Relation, IsParallelWithinFifteenDegrees) {
    for (const double yaw : {14.9, 15.1}) {
        const PlaneMap map =
            scene::map_of({upright(0, 0, 0, 0, 4, 2), upright(2, 0, 0, yaw * kDegree, 4, 2)});
        EXPECT_EQ(between(map, 0, 1).distance.has_value(), yaw * kDegree < kParallel_rad);
    }
}

TEST(Relation, IsTheSameBothWaysAndInAnyWorld) {
    test::Random random(6);
    for (int i = 0; i < 30; ++i) {
        const Pose there = random.pose(5);
        const double yaw = random.uniform(-14, 14) * kDegree + (i % 2 == 0 ? kPi : 0);
        const std::vector<scene::Rectangle> two{
            upright(0, 0, 0, 0, 4, 2),
            upright(random.uniform(0.5, 3), random.uniform(-1, 1), 0.5, yaw, 2, 2)};
        const PlaneMap here = scene::map_of(two), moved = scene::map_of(two, there);
        const PlaneRelation r = between(here, 0, 1), turned = between(here, 1, 0),
                            other = between(moved, 0, 1);
        EXPECT_EQ(r.angle, turned.angle);
        EXPECT_EQ(r.distance, turned.distance);
        EXPECT_EQ(r.distance_sigma, turned.distance_sigma);
        EXPECT_EQ(r.on_a, turned.on_b);
        EXPECT_EQ(r.sides, turned.sides);
        EXPECT_NEAR(r.angle, other.angle, 1e-6);
        EXPECT_NEAR(r.distance.value(), other.distance.value(), 1e-3);
        EXPECT_NEAR(r.opposite, other.opposite, 0.02 * r.opposite);
        EXPECT_NEAR((r.on_a - r.on_b).norm(), r.distance.value(), 1e-6);
        EXPECT_NEAR(here.planes[0].plane().signed_distance(r.on_a), 0, 1e-6);
        EXPECT_NEAR(here.planes[1].plane().signed_distance(r.on_b), 0, 1e-6);
    }
}

TEST(Relation, IsMeasuredWhereTheOutlinesLieOpposite) {
    // The second wall goes away from the first by 2 deg, and is before its end alone.
    const double slope = std::tan(2 * kDegree);
    const PlaneMap map =
        scene::map_of({upright(0, 0, 0, 0, 8, 2), upright(2, 3, 0, 2 * kDegree + kPi, 2, 2)});
    const PlaneRelation r = between(map, 0, 1);
    EXPECT_NEAR(r.distance.value(), 2, 0.005);
    EXPECT_NEAR(r.opposite, 4, 0.05);
    EXPECT_NEAR(r.on_a.y(), 3, 0.05);
    EXPECT_NEAR(r.least, 2 - slope, 0.005);
    EXPECT_NEAR(r.most, 2 + slope, 0.005);
    // Beside each other: between their middles.
    const PlaneMap beside = scene::map_of({upright(0, 0, 0, 0, 1, 2), upright(2, 5, 0, kPi, 1, 2)});
    EXPECT_NEAR(between(beside, 0, 1).distance.value(), 2, 1e-6);
    EXPECT_EQ(between(beside, 0, 1).opposite, 0);
    EXPECT_EQ(between(beside, 0, 1).least, between(beside, 0, 1).distance.value());
}

TEST(Relation, SaysWhichSidesWereSeen) {
    const PlaneMap map = scene::map_of({upright(0, 0, 0, 0, 4, 2), upright(3, 0, 0, kPi, 4, 2),
                                        upright(-0.12, 0, 0, kPi, 4, 2), upright(-1, 0, 0, 0, 4, 2)});
    EXPECT_EQ(between(map, 0, 1).sides, Sides::kFacing);
    EXPECT_EQ(between(map, 0, 2).sides, Sides::kBackToBack);
    EXPECT_EQ(between(map, 0, 3).sides, Sides::kSameWay);
    EXPECT_EQ(between(map, 1, 2).sides, Sides::kSameWay);
}

TEST(Certainty, IsWhatFitsOfThatManyReadingsScatterBy) {
    // A plane through one reading a keyframe, anywhere in the box: how far its middle and slopes are off.
    constexpr int kKeyframes = 40, kTrials = 4000;
    constexpr double kRms = 0.01, kHalfX = 2, kHalfY = 0.5;
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, kRms);
    std::uniform_real_distribution<double> place(-1, 1);
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (int trial = 0; trial < kTrials; ++trial) {
        Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
        Eigen::Vector3d pull = Eigen::Vector3d::Zero();
        for (int k = 0; k < kKeyframes; ++k) {
            const Eigen::Vector3d row(1, kHalfX * place(random), kHalfY * place(random));
            information += row * row.transpose();
            pull += noise(random) * row;
        }
        squares += information.inverse().operator*(pull).cwiseAbs2();
    }
    const Eigen::Vector3d sigmas = (squares / kTrials).cwiseSqrt();

    PlaneMap map = scene::map_of({level(0, 0, 0, kHalfX, kHalfY)});
    MapPlane& plane = map.planes[0];
    plane.rms = static_cast<float>(kRms);
    plane.keyframes = kKeyframes;
    const PlaneCertainty certainty = certainty_of(plane).value();
    EXPECT_NEAR(certainty.offset / sigmas[0], 1, 0.1);
    EXPECT_NEAR(certainty.slopes.x() / sigmas[1], 1, 0.1);
    EXPECT_NEAR(certainty.slopes.y() / sigmas[2], 1, 0.1);
    EXPECT_NEAR(certainty.offset_at(plane, {0, 0, 0}), certainty.offset, 1e-6);
    EXPECT_NEAR(certainty.offset_at(plane, {2, 0, 0}), std::hypot(certainty.offset, 2 * certainty.slopes.x()),
                1e-6);
    EXPECT_NEAR(certainty.tilt_towards(plane, {0, 3, 0}), certainty.slopes.y(), 1e-6);
    EXPECT_NEAR(certainty.tilt_towards(plane, {0, 0, 0}), certainty.slopes.y(), 1e-9) << "the larger one";
}

TEST(Certainty, IsNotKnownWhereTheMapDoesNotSay) {
    const PlaneMap good = scene::map_of({upright(0, 0, 0, 0, 4, 2), upright(3, 0, 0, kPi, 4, 2)});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto sigma_with = [&](const auto& change) {
        PlaneMap map = good;
        for (MapPlane& plane : map.planes) plane.rms = 0.01f;
        change(map.planes[1]);
        const PlaneRelation r = between(map, 0, 1);
        EXPECT_TRUE(r.distance);
        EXPECT_EQ(r.distance_sigma.has_value(), r.angle_sigma.has_value());
        return r.distance_sigma;
    };
    EXPECT_TRUE(sigma_with([](MapPlane&) {}));
    EXPECT_FALSE(sigma_with([](MapPlane& plane) { plane.keyframes = 0; }));
    EXPECT_FALSE(sigma_with([](MapPlane& plane) { plane.rms = 0; }));
    EXPECT_FALSE(sigma_with([&](MapPlane& plane) { plane.rms = nan; }));
    EXPECT_FALSE(sigma_with([](MapPlane& plane) { plane.half_extents.x() = 0; }));
    EXPECT_FALSE(sigma_with([&](MapPlane& plane) { plane.half_extents.y() = nan; }));
    EXPECT_LT(sigma_with([](MapPlane& plane) { plane.keyframes = 300; }).value(),
              sigma_with([](MapPlane&) {}).value());
}

TEST(Relation, OfDegeneratePlanes) {
    PlaneMap map = scene::map_of({upright(0, 0, 0, 0, 4, 2), upright(3, 0, 0, kPi, 4, 2)});
    EXPECT_EQ(relation(map.planes[0], map.planes[0]).distance, 0.0);
    PlaneMap bare = map;
    bare.planes[1].outline = {};
    EXPECT_NEAR(between(bare, 0, 1).distance.value(), 3, 1e-6) << "between their middles";
    EXPECT_EQ(between(bare, 0, 1).opposite, 0);
    PlaneMap wide = map;
    wide.planes[0].outline.unit = wide.planes[1].outline.unit = std::numeric_limits<float>::infinity();
    EXPECT_EQ(between(wide, 0, 1).opposite, 0);
    wide.planes[0].outline.unit = wide.planes[1].outline.unit = 1e30f;
    EXPECT_TRUE(std::isfinite(between(wide, 0, 1).distance.value()));
    PlaneMap lost = map;
    lost.planes[1].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(std::isnan(between(lost, 0, 1).angle));
    EXPECT_FALSE(between(lost, 0, 1).distance);
}

}  // namespace
}  // namespace planemap::map
