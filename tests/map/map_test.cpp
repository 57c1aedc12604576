// SPDX-License-Identifier: BSD-3-Clause
#include "map/map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "core/geometry/crossing.hpp"
#include "core/scene.hpp"
#include "heap.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;
using scene::facing;
using scene::keyframe;
using scene::Rectangle;
using scene::region_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A room of 4 x 3 x 2.4 m whose inside is seen, and a table in it.
std::vector<Rectangle> room() {
    return {{facing({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 2, 1.5, {}},
            {facing({2, 0, 1.2}, {-1, 0, 0}, {0, 1, 0}), 1.5, 1.2, {}},
            {facing({-2, 0, 1.2}, {1, 0, 0}, {0, 1, 0}), 1.5, 1.2, {}},
            {facing({0, 1.5, 1.2}, {0, -1, 0}, {1, 0, 0}), 2, 1.2, {}},
            {facing({0.5, 0.3, 0.75}, {0, 0, 1}, {0.8, 0.6, 0}), 0.6, 0.4, {}}};
}

KeyframeTrajectory trajectory_of(const std::vector<Pose>& poses, int revision = 1) {
    KeyframeTrajectory trajectory;
    trajectory.revision = revision;
    for (const Pose& pose : poses)
        trajectory.keyframes.push_back({static_cast<int>(trajectory.keyframes.size()), 0, pose});
    return trajectory;
}

const MapPlane* nearest(const PlaneMap& map, const MapPlane& wanted) {
    const MapPlane* best = nullptr;
    double best_apart = 0.1;
    for (const MapPlane& plane : map.planes) {
        const double apart = angle_between(plane.plane().normal, wanted.plane().normal) +
                             static_cast<double>((plane.center - wanted.center).norm());
        if (apart < best_apart) {
            best = &plane;
            best_apart = apart;
        }
    }
    return best;
}

/// The same planes, whatever their order and ids.
void expect_same_planes(const PlaneMap& a, const PlaneMap& b, double tolerance_m) {
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (const MapPlane& plane : a.planes) {
        const MapPlane* twin = nearest(b, plane);
        ASSERT_NE(twin, nullptr);
        EXPECT_NEAR(angle_between(plane.plane().normal, twin->plane().normal), 0, tolerance_m);
        EXPECT_NEAR(plane.plane().d, twin->plane().d, tolerance_m);
        EXPECT_EQ(plane.inliers, twin->inliers);
        EXPECT_NEAR(static_cast<double>((plane.half_extents - twin->half_extents).norm()), 0,
                    20 * tolerance_m);
        EXPECT_NEAR(plane.area, twin->area, 0.01 * plane.area + 0.03) << "half a cell around";
        EXPECT_EQ(plane.keyframes, twin->keyframes);
    }
    EXPECT_EQ(a.lines.size(), b.lines.size());
    EXPECT_EQ(a.points.size(), b.points.size());
}

void expect_identical(const PlaneMap& a, const PlaneMap& b) {
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (std::size_t i = 0; i < a.planes.size(); ++i) {
        EXPECT_EQ(a.planes[i].id, b.planes[i].id);
        EXPECT_EQ(a.planes[i].normal, b.planes[i].normal);
        EXPECT_EQ(a.planes[i].center, b.planes[i].center);
        EXPECT_EQ(a.planes[i].outline, b.planes[i].outline);
        EXPECT_EQ(a.planes[i].keyframes, b.planes[i].keyframes);
    }
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) EXPECT_EQ(a.lines[i].from, b.lines[i].from);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].position, b.points[i].position);
}

TEST(PlaneMapper, TheNoisierTheSensorTheLessAFarViewWeighs) {
    // A wall from 1 m, and from 4 m, where it seems to lie 1 cm further back.
    const auto distance_of_wall = [](const DepthNoise& noise) {
        PlaneMapper mapper;
        for (const double away : {0.0, 3.0}) {
            Pose world_from_camera = Pose::Identity();
            world_from_camera.translation().z() = -away;
            const Rectangle wall{facing({0, 0, away > 0 ? 1.01 : 1.0}, {0, 0, -1}, {1, 0, 0}), 0.8, 0.7, {}};
            Keyframe seen;
            seen.id = away > 0 ? 1 : 0;
            seen.utime = seen.id;
            seen.noise = noise;
            seen.regions = {region_of(wall, world_from_camera, 0.02)};
            mapper.add(seen, world_from_camera);
        }
        mapper.settle();
        EXPECT_EQ(mapper.map().planes.size(), 1u);
        return mapper.map().planes.empty() ? 0 : mapper.map().planes[0].plane().d;
    };
    const DepthNoise noise, twice{2 * noise.base_m, 2 * noise.quadratic_per_m, noise.offset_m};
    EXPECT_GT(distance_of_wall(noise), 1.0005);
    EXPECT_LT(distance_of_wall(twice), distance_of_wall(noise) - 0.0003);
}

TEST(PlaneMapper, MergedPlaneIsTheFitToAllPoints) {
    const Rectangle left{facing({-0.8, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}};
    const Rectangle right{facing({0.7, 0.2, 3.01}, {0.01, 0, -1}, {1, 0, 0}), 0.8, 0.7, {}};
    Keyframe seen;
    seen.id = 0;
    seen.regions = {region_of(left, Pose::Identity(), 0.02, 0.003, 1),
                    region_of(right, Pose::Identity(), 0.02, 0.003, 2)};
    seen.noise = {0, 0, 0};
    // Both count alike, whatever their depth, when poses are off by far more than the sensor, and the planes
    // by far less than that.
    MapOptions options;
    options.pose_sigma_m = 10;
    options.agreement_m = 100;
    PlaneMapper mapper(options);
    mapper.add(seen, Pose::Identity());
    ASSERT_EQ(mapper.map().planes.size(), 1u);

    Moments all;
    for (const auto& [rectangle, seed] : {std::pair(left, 1), std::pair(right, 2)}) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        for (const auto& p : scene::points_on(rectangle, 0.02, 0.003, random)) all.add(p);
    }
    const PlaneFit fit = fit_plane(all);
    const MapPlane& merged = mapper.map().planes[0];
    ASSERT_EQ(mapper.estimates().size(), 1u);
    const Moments& moments = mapper.estimates()[0].moments;
    EXPECT_EQ(moments.count, all.count);
    EXPECT_LT((moments.mean() - all.mean()).norm(), 1e-6);
    EXPECT_LT((moments.covariance() - all.covariance()).norm(), 1e-6);
    EXPECT_NEAR(angle_between(merged.plane().normal, fit.plane.normal), 0, 1e-6);
    EXPECT_NEAR(merged.plane().d, fit.plane.d, 2e-6);
    EXPECT_NEAR(static_cast<double>(merged.rms), fit.rms, 1e-6);
}

TEST(PlaneMapper, BoxKeepsTheExtrema) {
    const Rectangle left{facing({-1, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.5, {}};
    const Rectangle right{facing({1.2, 0, 3}, {0, 0, -1}, {1, 0, 0}), 0.9, 0.4, {}};
    PlaneMapper mapper;
    mapper.add(keyframe(0, {left, right}, Pose::Identity()), Pose::Identity());
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    const Box box = mapper.map().planes[0].box();
    EXPECT_NEAR(box.half_extents.x(), 2.05, 0.02);
    EXPECT_NEAR(box.half_extents.y(), 0.5, 0.02);
    EXPECT_NEAR(mapper.map().planes[0].area, 2 + 1.8 * 0.8, 0.1);
}

TEST(PlaneMapper, AFarViewDoesNotOutweighNearOnes) {
    PlaneMapper mapper;
    const Rectangle wall{facing({0, 0, 0}, {0, 0, -1}, {1, 0, 0}), 0.8, 0.6, {}};
    Rectangle misplaced = wall;
    misplaced.world_from_face.translation().z() = 0.04;
    for (int i = 0; i < 10; ++i)
        mapper.add(keyframe(i, {wall}, camera_at({0, 0, -1})), camera_at({0, 0, -1}));
    mapper.add(keyframe(10, {misplaced}, camera_at({0, 0, -4})), camera_at({0, 0, -4}));
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    const PlanarRegion region = mapper.map().planes[0].region();
    EXPECT_LT(std::abs(region.plane.signed_distance({0, 0, 0})), 0.04 / 11 / 2);
    EXPECT_NEAR(region.moments.count, 11 * 80 * 60, 1) << "the moments stay exact";
}

TEST(PlaneMapper, TheTwoSidesOfAWallAreTwoPlanes) {
    const Rectangle front{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}};
    const Rectangle back{facing({0, 0, 2.02}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}};
    PlaneMapper mapper;
    mapper.add(keyframe(0, {front}, camera_at({0, 0, 0})), camera_at({0, 0, 0}));
    mapper.add(keyframe(1, {back}, camera_at({0, 0, 4}, 3)), camera_at({0, 0, 4}, 3));
    ASSERT_EQ(mapper.map().planes.size(), 2u);
    EXPECT_LT(mapper.map().planes[0].plane().normal.z(), -0.999);
    EXPECT_GT(mapper.map().planes[1].plane().normal.z(), 0.999);
}

TEST(PlaneMapper, MergesTransitively) {
    // Two parts of a wall 1.2 m apart stay two until the part between them is seen.
    const auto part = [](double x) {
        return Rectangle{facing({x, 0, 2}, {0, 0, -1}, {1, 0, 0}), 0.4, 0.5, {}};
    };
    PlaneMapper mapper;
    const Pose camera = Pose::Identity();
    mapper.add(keyframe(0, {part(-1)}, camera), camera);
    mapper.add(keyframe(1, {part(1)}, camera), camera);
    ASSERT_EQ(mapper.map().planes.size(), 2u);
    const int first = mapper.map().planes[0].id;
    mapper.add(keyframe(2, {part(0)}, camera), camera);
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    EXPECT_EQ(mapper.map().planes[0].id, first) << "the older id stays";
    EXPECT_THAT(mapper.sightings().at(first), ElementsAre(0, 1, 2));
}

TEST(PlaneMapper, NoPairSatisfiesTheRulesAfterwards) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> at(-2, 2), tilt(-0.15, 0.15), size(0.1, 0.6);
    PlaneMapper mapper;
    for (int i = 0; i < 40; ++i) {
        std::vector<Rectangle> seen;
        for (int k = 0; k < 4; ++k) {
            seen.push_back({facing({at(random), at(random), 3 + 0.02 * at(random)},
                                   {tilt(random), tilt(random), -1}, {1, 0, 0}),
                            size(random),
                            size(random),
                            {}});
        }
        mapper.add(keyframe(i, seen, Pose::Identity()), Pose::Identity());
    }
    const auto& planes = mapper.map().planes;
    double inliers = 0;
    for (const MapPlane& plane : planes) inliers += static_cast<double>(plane.inliers);
    EXPECT_GT(inliers, 1000);
    EXPECT_LT(planes.size(), 40u);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        EXPECT_TRUE(is_valid(planes[i].region()));
        EXPECT_FALSE(rings_cross(planes[i].outline.rings()));
    }
}

TEST(PlaneMapper, AnOpenDoorIsAHole) {
    Rectangle wall{
        facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 2, 1.2, {scene::rectangle_ring(-0.4, -0.9, 0.4, 0.9)}};
    PlaneMapper mapper;
    for (int i = 0; i < 5; ++i)
        mapper.add(keyframe(i, {wall}, camera_at({0.1 * i, 0, 0}), 0.003), camera_at({0.1 * i, 0, 0}));
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    const MapPlane& plane = mapper.map().planes[0];
    EXPECT_EQ(plane.outline.ring_count(), 2u);
    EXPECT_NEAR(plane.area, 4 * 2.4 - 0.8 * 1.8, 0.15);
    EXPECT_GT(distance(plane, {0, 0, 2}), 0.3);
    EXPECT_LT(distance(plane, {1, 0, 2}), 0.01);
}

TEST(PlaneMapper, KeyframesAndTrajectoryMayComeInAnyOrder) {
    std::vector<Keyframe> keyframes;
    std::vector<Pose> poses;
    for (int i = 0; i < 6; ++i) {
        poses.push_back(camera_at({0.1 * i, 0, 1}, 0.2 * i));
        keyframes.push_back(keyframe(i, room(), poses.back(), 0.002));
    }
    PlaneMapper keyframes_first, trajectory_first, mixed, with_poses;
    for (const Keyframe& k : keyframes) keyframes_first.add(k);
    EXPECT_TRUE(keyframes_first.map().planes.empty());
    EXPECT_EQ(keyframes_first.waiting(), 6u);
    keyframes_first.update(trajectory_of(poses));
    EXPECT_EQ(keyframes_first.waiting(), 0u);
    trajectory_first.update(trajectory_of(poses));
    for (const Keyframe& k : keyframes) trajectory_first.add(k);
    for (const std::size_t i : {4, 1, 5}) mixed.add(keyframes[i]);
    mixed.update(trajectory_of(poses));
    for (const std::size_t i : {3, 0, 2}) mixed.add(keyframes[i]);
    for (std::size_t i = 0; i < 6; ++i) with_poses.add(keyframes[i], poses[i]);

    EXPECT_EQ(keyframes_first.map().planes.size(), 5u);
    expect_same_planes(keyframes_first.map(), mixed.map(), 2e-3);
    for (PlaneMapper* mapper : {&keyframes_first, &trajectory_first, &mixed, &with_poses}) mapper->settle();
    expect_same_planes(keyframes_first.map(), trajectory_first.map(), 1e-9);
    expect_same_planes(keyframes_first.map(), with_poses.map(), 1e-9);
    expect_same_planes(keyframes_first.map(), mixed.map(), 1e-9);
    EXPECT_EQ(mixed.map().utime, keyframes.back().utime);
    EXPECT_EQ(mixed.map().revision, 1);
}

TEST(PlaneMapper, OrderOfIdsHardlyMatters) {
    PlaneMapper forwards, backwards;
    for (int i = 0; i < 8; ++i) {
        const Pose pose = camera_at({0.1 * i, 0, 1}, 0.2 * i);
        Keyframe seen = keyframe(i, room(), pose, 0.004);
        forwards.add(seen, pose);
        seen.id = 7 - i;
        std::reverse(seen.regions.begin(), seen.regions.end());
        backwards.add(seen, pose);
    }
    expect_same_planes(forwards.map(), backwards.map(), 2e-3);
    forwards.settle();
    backwards.settle();
    expect_same_planes(forwards.map(), backwards.map(), 1e-6);
}

TEST(PlaneMapper, RebuildEqualsAFreshBuildAndKeepsIds) {
    PlaneMapper corrected, fresh;
    std::vector<Pose> after;
    for (int i = 0; i < 6; ++i) {
        const Pose truth = camera_at({0.1 * i, 0, 1}, 0.2 * i);
        const Keyframe seen = keyframe(i, room(), truth, 0.002);
        const Pose drifted = camera_at({0.02 * i, 0.01 * i, 0.03 * i}, 0.002 * i) * truth;
        corrected.add(seen, drifted);
        after.push_back(truth);
        fresh.add(seen, truth);
    }
    std::map<int, Eigen::Vector3d> before;
    for (const MapPlane& plane : corrected.map().planes) before[plane.id] = plane.center.cast<double>();
    corrected.update(trajectory_of(after, 3));
    EXPECT_EQ(corrected.work().rebuilds, 1u);
    EXPECT_EQ(corrected.map().revision, 3);
    fresh.settle();
    expect_same_planes(corrected.map(), fresh.map(), 1e-9);
    int kept = 0;
    for (const MapPlane& plane : corrected.map().planes) {
        if (!before.contains(plane.id)) continue;
        ++kept;
        EXPECT_LT((plane.center.cast<double>() - before[plane.id]).norm(), 0.5);
    }
    EXPECT_EQ(kept, 5);
}

TEST(PlaneMapper, IdsAreKeptWhenPlanesPart) {
    // A drifted view doubles a wall; the correction brings both together, and the next one parts them again.
    const Rectangle wall{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}};
    const Pose here = Pose::Identity(), off = camera_at({0, 0, 0.2});
    PlaneMapper mapper;
    for (int i = 0; i < 3; ++i) mapper.add(keyframe(i, {wall}, here), here);
    mapper.add(keyframe(3, {wall}, here), off);
    ASSERT_EQ(mapper.map().planes.size(), 2u);
    const int first = mapper.map().planes[0].id, second = mapper.map().planes[1].id;
    mapper.update(trajectory_of({here, here, here, here}));
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    EXPECT_EQ(mapper.map().planes[0].id, first);
    mapper.update(trajectory_of({here, here, here, off}));
    ASSERT_EQ(mapper.map().planes.size(), 2u);
    EXPECT_EQ(mapper.map().planes[0].id, first);
    EXPECT_GT(mapper.map().planes[1].id, second) << "an id that is gone is not used again";
}

TEST(PlaneMapper, SmallMovesDoNotRebuild) {
    PlaneMapper mapper;
    const Pose pose = camera_at({0, 0, 1});
    mapper.add(keyframe(0, room(), pose), pose);
    mapper.update(trajectory_of({camera_at({0.001, 0, 1})}));
    EXPECT_EQ(mapper.work().rebuilds, 0u);
    mapper.update(trajectory_of({camera_at({0.003, 0, 1})}));
    EXPECT_EQ(mapper.work().rebuilds, 1u);
}

TEST(PlaneMapper, ARepeatedKeyframeCountsOnce) {
    PlaneMapper once, twice;
    const Pose pose = camera_at({0, 0, 1});
    once.add(keyframe(0, room(), pose), pose);
    twice.add(keyframe(0, room(), pose), pose);
    twice.add(keyframe(0, room(), pose), pose);
    expect_same_planes(once.map(), twice.map(), 1e-9);
}

TEST(PlaneMapper, RoomHasItsLinesAndCorners) {
    PlaneMapper mapper;
    for (int i = 0; i < 3; ++i) {
        const Pose pose = camera_at({0.1 * i, 0, 1}, 0.3 * i);
        mapper.add(keyframe(i, room(), pose, 0.002), pose);
    }
    const PlaneMap& map = mapper.map();
    ASSERT_EQ(map.planes.size(), 5u);
    EXPECT_EQ(map.lines.size(), 5u) << "floor with three walls, and two edges between walls";
    EXPECT_EQ(map.points.size(), 2u);
    for (const IntersectionPoint& point : map.points) {
        EXPECT_NEAR(std::abs(point.position.x()), 2, 0.005);
        EXPECT_NEAR(point.position.y(), 1.5, 0.005);
        EXPECT_NEAR(point.position.z(), 0, 0.005);
    }
}

TEST(PlaneMapper, IntersectionsFollowChangedPlanes) {
    // Intersections kept step by step are those of a map built at once.
    PlaneMapper stepwise, at_once;
    std::vector<Pose> poses;
    const auto planes = room();
    for (int i = 0; i < 5; ++i) {
        poses.push_back(camera_at({0.1 * i, 0, 1}, 0.2 * i));
        const Keyframe seen = keyframe(i, {planes[static_cast<std::size_t>(i)]}, poses.back(), 0.002);
        stepwise.add(seen, poses.back());
        at_once.add(seen);
    }
    at_once.update(trajectory_of(poses));
    expect_identical(stepwise.map(), at_once.map());
}

TEST(PlaneMapper, ThreadsDoNotChangeTheResult) {
    MapOptions one, many;
    one.threads = 1;
    many.threads = 5;
    PlaneMapper alone(one), together(many);
    for (int i = 0; i < 6; ++i) {
        const Pose pose = camera_at({0.1 * i, 0, 1}, 0.2 * i);
        for (PlaneMapper* mapper : {&alone, &together}) mapper->add(keyframe(i, room(), pose, 0.003), pose);
    }
    alone.settle();
    together.settle();
    EXPECT_EQ(alone.work().rebuilds, 1u);
    expect_identical(alone.map(), together.map());
}

TEST(PlaneMapper, SettlingTwiceChangesNothing) {
    PlaneMapper mapper;
    const Pose pose = camera_at({0, 0, 1});
    for (int i = 0; i < 3; ++i) mapper.add(keyframe(i, room(), pose, 0.003), pose);
    mapper.settle();
    const PlaneMap once = mapper.map();
    mapper.settle();
    EXPECT_EQ(mapper.work().rebuilds, 1u);
    expect_identical(once, mapper.map());
}

TEST(PlaneMapper, WhatIsLookedThroughGoes) {
    // A plate is seen once, from afar; then the wall behind it, again and again.
    const Rectangle plate{facing({0, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.4, {}};
    const Rectangle wall{facing({0, 0, 3.5}, {0, 0, -1}, {1, 0, 0}), 2, 1.5, {}};
    const Pose afar = camera_at({0, 0, -1}), near = camera_at({0, 0, 1});
    PlaneMapper mapper;
    mapper.add(keyframe(0, {plate}, afar), afar);
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    for (int i = 1; i < 4; ++i) mapper.add(keyframe(i, {wall}, near), near);
    ASSERT_EQ(mapper.map().planes.size(), 1u);
    EXPECT_NEAR(static_cast<double>(mapper.map().planes[0].center.z()), 3.5, 0.01) << "the wall is left";
    mapper.settle();
    EXPECT_EQ(mapper.map().planes.size(), 1u) << "and a rebuild says the same";
    // The wall is not looked through by views that see the plate before it.
    PlaneMapper both;
    for (int i = 0; i < 4; ++i) both.add(keyframe(i, {plate, wall}, near), near);
    EXPECT_EQ(both.map().planes.size(), 2u);
}

TEST(PlaneMapper, FoldedKeyframesStayInThePlanes) {
    MapOptions options;
    options.fold_after = 3;
    PlaneMapper folding(options), keeping;
    for (int i = 0; i < 12; ++i) {
        const Pose pose = camera_at({0.05 * i, 0, 1}, 0.1 * i);
        for (PlaneMapper* mapper : {&folding, &keeping}) mapper->add(keyframe(i, room(), pose, 0.002), pose);
    }
    EXPECT_EQ(folding.work().folded, 9u);
    EXPECT_EQ(keeping.work().folded, 0u);
    std::set<int> ids;
    for (const MapPlane& plane : folding.map().planes) ids.insert(plane.id);
    folding.settle();
    keeping.settle();
    ASSERT_EQ(folding.map().planes.size(), keeping.map().planes.size());
    for (const MapPlane& plane : folding.map().planes) {
        EXPECT_TRUE(ids.contains(plane.id));
        const MapPlane* twin = nearest(keeping.map(), plane);
        ASSERT_NE(twin, nullptr);
        EXPECT_NEAR(angle_between(plane.plane().normal, twin->plane().normal), 0, 1e-3);
        EXPECT_EQ(plane.inliers, twin->inliers) << "every point is still counted";
        EXPECT_EQ(plane.keyframes, twin->keyframes);
        EXPECT_NEAR(plane.area, twin->area, 0.03f * twin->area);
    }
    EXPECT_EQ(folding.waiting(), 0u);
}

TEST(PlaneMapper, ReplacedKeyframesLeaveTheirPointsAndTheirSurface) {
    PlaneMapper thinned, keeping;
    KeyframeTrajectory all = trajectory_of({});
    std::vector<Rectangle> with_shelf = room();
    with_shelf.push_back({facing({-1, -0.5, 1.1}, {0, 0, 1}, {1, 0, 0}), 0.4, 0.3, {}});
    for (int i = 0; i < 12; ++i) {
        const Pose pose = camera_at({0.05 * i, 0, 1}, 0.1 * i);
        all.keyframes.push_back({i, 0, pose});
        // Only keyframe 3 sees the shelf.
        const Keyframe seen = keyframe(i, i == 3 ? with_shelf : room(), pose, 0.002);
        for (PlaneMapper* mapper : {&thinned, &keeping}) {
            mapper->add(seen);
            mapper->update(all);
        }
    }
    ASSERT_EQ(keeping.map().planes.size(), 6u) << "4 walls and floor, a table, a shelf";
    KeyframeTrajectory some = all;
    std::erase_if(some.keyframes, [](const KeyframePose& k) { return k.id % 4 != 0; });
    thinned.update(some);
    EXPECT_EQ(thinned.keyframes(), 3u);
    EXPECT_EQ(thinned.work().replaced, 9u);
    EXPECT_LT(thinned.working_bytes(), keeping.working_bytes());
    std::set<int> ids;
    for (const MapPlane& plane : thinned.map().planes) ids.insert(plane.id);
    thinned.settle();
    keeping.settle();
    ASSERT_EQ(thinned.map().planes.size(), keeping.map().planes.size());
    for (const MapPlane& plane : thinned.map().planes) {
        EXPECT_TRUE(ids.contains(plane.id));
        const MapPlane* twin = nearest(keeping.map(), plane);
        ASSERT_NE(twin, nullptr);
        EXPECT_NEAR(angle_between(plane.plane().normal, twin->plane().normal), 0, 1e-3);
        EXPECT_NEAR(plane.plane().d, twin->plane().d, 1e-3);
        EXPECT_NEAR(plane.inliers, twin->inliers, 1e-5 * twin->inliers) << "every point is still counted";
        EXPECT_EQ(plane.keyframes, twin->keyframes);
        EXPECT_NEAR(plane.area, twin->area, 0.03f * twin->area);
    }
    // And they go where their keepers go.
    KeyframeTrajectory moved = some;
    for (KeyframePose& k : moved.keyframes) k.world_from_camera.pretranslate(Eigen::Vector3d(0, 0, 0.5));
    thinned.update(moved);
    ASSERT_EQ(thinned.map().planes.size(), 6u);
    for (const MapPlane& plane : keeping.map().planes) {
        MapPlane higher = plane;
        higher.center.z() += 0.5f;
        EXPECT_NE(nearest(thinned.map(), higher), nullptr);
    }
}

TEST(PlaneMapper, ATrajectoryThatSharesNothingWithTheLastTakesNothingAway) {
    PlaneMapper mapper;
    const Pose pose = camera_at({0, 0, 1});
    mapper.add(keyframe(0, room(), pose));
    mapper.update(trajectory_of({pose}));
    KeyframeTrajectory other;
    other.keyframes = {{7, 0, pose}};
    mapper.update(other);
    mapper.update({});
    mapper.settle();
    EXPECT_EQ(mapper.keyframes(), 1u);
    EXPECT_EQ(mapper.map().planes.size(), 5u);
}

/// The one that was to take over had been lost on its way: the process died.
TEST(PlaneMapper, AReplacedKeyframeStaysWhenThereIsNoneToTakeOver) {
    PlaneMapper mapper;
    const Pose pose = camera_at({0, 0, 1});
    mapper.add(keyframe(0, room(), pose));
    mapper.update(trajectory_of({pose, pose}));
    KeyframeTrajectory without_it;
    without_it.keyframes = {{1, 0, pose}};
    mapper.update(without_it);
    EXPECT_EQ(mapper.work().replaced, 0u);
    EXPECT_EQ(mapper.keyframes(), 1u);
    mapper.settle();
    EXPECT_EQ(mapper.map().planes.size(), 5u);
}

TEST(PlaneMapper, GoesOnFromAMap) {
    PlaneMapper before;
    for (int i = 0; i < 4; ++i) {
        const Pose pose = camera_at({0.1 * i, 0, 1}, 0.2 * i);
        before.add(keyframe(i, room(), pose, 0.002), pose);
    }
    PlaneMapper after;
    after.start_from(before.map());
    ASSERT_EQ(after.map().planes.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        const MapPlane &a = before.map().planes[i], &b = after.map().planes[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_NEAR(angle_between(a.plane().normal, b.plane().normal), 0, 1e-5);
        EXPECT_NEAR(a.area, b.area, 0.03f * a.area);
        EXPECT_EQ(a.keyframes, b.keyframes);
    }
    const Pose pose = camera_at({0, 0, 1});
    const Rectangle chair{facing({-1, -0.5, 0.45}, {0, 0, 1}, {1, 0, 0}), 0.3, 0.3, {}};
    std::vector<Rectangle> with_chair = room();
    with_chair.push_back(chair);
    for (int i = 0; i < 2; ++i) after.add(keyframe(i, with_chair, pose, 0.002), pose);
    after.settle();
    ASSERT_EQ(after.map().planes.size(), 6u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(after.map().planes[i].id, before.map().planes[i].id);
        EXPECT_GT(after.map().planes[i].inliers, 1.4f * before.map().planes[i].inliers);
    }
    EXPECT_GT(after.map().planes[5].id, before.map().planes[4].id);
}

/// Fifty planes of 200 x 200 m took 3.2 GB for each copy of their rasters, and the run died.
TEST(PlaneMapper, TheRastersOfAHugeMapAreBounded) {
    PlaneMap huge;
    for (int i = 0; i < 50; ++i) {
        const Rectangle storey{facing({0, 0, 4.0 * i}, {0, 0, 1}, {1, 0, 0}), 100, 100, {}};
        huge.planes.emplace_back(i, region_of(storey, Pose::Identity(), 1), 10);
    }
    const Rectangle table{facing({0, 0, 1}, {0, 0, 1}, {1, 0, 0}), 0.6, 0.4, {}};
    huge.planes.emplace_back(50, region_of(table, Pose::Identity()), 10);
    PlaneMapper mapper;
    mapper.start_from(huge);
    EXPECT_LT(mapper.working_bytes(), std::size_t{600} << 20);
    EXPECT_EQ(mapper.losses().planes_refused, 0u);
    EXPECT_EQ(mapper.work().coarsened, 50u) << "the table has the room it needs";
    ASSERT_EQ(mapper.map().planes.size(), 51u);
    for (const MapPlane& plane : mapper.map().planes)
        EXPECT_NEAR(plane.area, plane.id == 50 ? 0.96 : 40000, plane.id == 50 ? 0.05 : 200);
}

/// 400 planes of 20 x 20 m through one another: ten million triples.
TEST(PlaneMapper, CornersOfACrowdedMapAreBounded) {
    PlaneMap crowded;
    std::mt19937_64 random(3);
    std::normal_distribution<double> any;
    for (int i = 0; i < 400; ++i) {
        const Eigen::Vector3d n = Eigen::Vector3d(any(random), any(random), any(random)).normalized();
        const Rectangle plane{
            facing(Eigen::Vector3d(any(random), any(random), any(random)), n, n.unitOrthogonal()),
            10,
            10,
            {}};
        crowded.planes.emplace_back(i, region_of(plane, Pose::Identity(), 1), 10);
    }
    PlaneMapper mapper;
    mapper.start_from(crowded);
    EXPECT_TRUE(mapper.left_out_corners());
    EXPECT_GT(mapper.map().points.size(), 1000u);
    PlaneMapper room_mapper;
    const Pose pose = camera_at({0, 0, 1});
    room_mapper.add(keyframe(0, room(), pose, 0.002), pose);
    EXPECT_FALSE(room_mapper.left_out_corners());
}

TEST(PlaneMapper, KeyframesThatWaitAreBounded) {
    PlaneMapper mapper;
    for (int i = 0; i < 5000; ++i) {
        Keyframe seen;
        seen.id = i;
        mapper.add(seen);
    }
    EXPECT_EQ(mapper.waiting(), 4096u);
    EXPECT_EQ(mapper.losses().keyframes_unplaced, 904u);
}

TEST(PlaneMapper, SmallAndSeldomSeenPlanesAreHeldBack) {
    MapOptions options;
    options.min_keyframes = 2;
    options.min_area_m2 = 0.1;
    PlaneMapper mapper(options);
    const Rectangle wall{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.5, {}};
    const Rectangle scrap{facing({2, 0, 2}, {0, -1, 0}, {1, 0, 0}), 0.1, 0.1, {}};
    mapper.add(keyframe(0, {wall, scrap}, Pose::Identity()), Pose::Identity());
    EXPECT_TRUE(mapper.map().planes.empty());
    mapper.add(keyframe(1, {wall, scrap}, Pose::Identity()), Pose::Identity());
    EXPECT_EQ(mapper.map().planes.size(), 1u);
}

TEST(PlaneMapper, MemoryOfTheMapDoesNotGrowWithRevisits) {
    PlaneMapper mapper;
    std::size_t after_first_lap = 0;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = camera_at({0.1 * (i % 5), 0, 1}, 0.2 * (i % 5));
        mapper.add(keyframe(i, room(), pose), pose);
        if (i == 9) after_first_lap = mapper.memory_bytes();
    }
    EXPECT_GT(after_first_lap, 5 * sizeof(MapPlane));
    EXPECT_LT(mapper.memory_bytes(), after_first_lap + 5 * 100 * sizeof(int));
    EXPECT_GT(mapper.working_bytes(), mapper.memory_bytes());
}

/// "working_bytes" and "keyframe_bytes" are what the allocator says, to a tenth.
TEST(PlaneMapper, OnTheHeapItTakesWhatIsSaid) {
    if (!test::heap_is_told()) GTEST_SKIP() << "this program's malloc does not tell what it gave out";
    std::vector<Keyframe> keyframes;
    std::vector<Pose> poses;
    for (int i = 0; i < 60; ++i) {
        poses.push_back(camera_at({0.1 * (i % 7), 0.05 * (i % 11), 1}, 0.1 * i));
        keyframes.push_back(keyframe(i, room(), poses.back(), 0.002));
    }
    const auto take_in = [&](PlaneMapper& mapper) {
        for (std::size_t i = 0; i < keyframes.size(); ++i) mapper.add(keyframes[i], poses[i]);
    };
    take_in(*std::make_unique<PlaneMapper>());  // what is made once for the program is not the map's
    const std::size_t before = test::heap_in_use();
    const auto mapper = std::make_unique<PlaneMapper>();
    take_in(*mapper);
    const auto taken = static_cast<double>(test::heap_in_use() - before);
    EXPECT_NEAR(static_cast<double>(mapper->working_bytes() + mapper->memory_bytes()), taken, 0.1 * taken);
}

TEST(PlaneMapper, RejectsWhatIsNotARegion) {
    const PlanarRegion good = region_of(room()[0], camera_at({0, 0, 1}));
    Keyframe hostile;
    hostile.id = 0;
    hostile.regions.assign(8, good);
    hostile.regions[0].plane.normal.x() = kNan;
    hostile.regions[1].moments.sum.y() = kNan;
    hostile.regions[2].moments = {};
    hostile.regions[3].outline.rings[0][0].x() = kNan;
    hostile.regions[4].box.half_extents.x() = 1e9;
    hostile.regions[5].box.frame_from_box.translation().x() = 1e9;
    hostile.regions[6].moments.scatter = hostile.regions[6].moments.sum *
                                         hostile.regions[6].moments.sum.transpose() /
                                         hostile.regions[6].moments.count;  // all points in one
    PlaneMapper mapper;
    mapper.add(hostile, camera_at({0, 0, 1}));
    EXPECT_EQ(mapper.losses().regions_refused, 7u);
    EXPECT_EQ(mapper.map().planes.size(), 1u);
}

TEST(PlaneMapper, SurvivesOutlinesFarFromTheirBox) {
    Keyframe hostile;
    hostile.id = 0;
    hostile.regions = {region_of(room()[0], camera_at({0, 0, 1}))};
    hostile.regions[0].outline.rings[0][0] = {1e12, -1e12};
    PlaneMapper mapper;
    mapper.add(hostile, camera_at({0, 0, 1}));
    EXPECT_EQ(mapper.losses().regions_refused, 1u);
    EXPECT_TRUE(mapper.map().planes.empty());
}

TEST(PlaneMapper, IgnoresPosesThatAreNone) {
    Pose bad = Pose::Identity();
    bad.translation().x() = kNan;
    PlaneMapper mapper;
    mapper.add(keyframe(0, room(), Pose::Identity()), bad);
    EXPECT_EQ(mapper.waiting(), 1u);
    mapper.update(trajectory_of({bad}));
    EXPECT_EQ(mapper.waiting(), 1u);
    mapper.update(trajectory_of({camera_at({1e9, 0, 0})}));
    EXPECT_TRUE(mapper.map().planes.empty()) << "too far out for millimetres";
    mapper.update(trajectory_of({Pose::Identity()}));
    EXPECT_EQ(mapper.map().planes.size(), 5u);
}

TEST(PlaneMapper, EmptyInput) {
    PlaneMapper mapper;
    mapper.update({});
    mapper.add(Keyframe{});
    mapper.add(Keyframe{}, Pose::Identity());
    EXPECT_TRUE(mapper.map().planes.empty());
    EXPECT_GT(mapper.memory_bytes(), 0u);
}

TEST(PlaneMapper, TakesThousandsOfRegions) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> at(-15, 15), unit(-1, 1), size(0.05, 0.5);
    PlaneMapper mapper;
    std::vector<Pose> poses;
    for (int i = 0; i < 60; ++i) {
        std::vector<Rectangle> seen;
        for (int k = 0; k < 50; ++k) {
            seen.push_back({facing({at(random), at(random), at(random)},
                                   {unit(random), unit(random), unit(random)}, {1, 0, 0}),
                            size(random),
                            size(random),
                            {}});
        }
        poses.push_back(Pose::Identity());
        Keyframe waiting;
        waiting.id = i;
        for (const Rectangle& r : seen) waiting.regions.push_back(region_of(r, poses.back(), 0.05));
        mapper.add(waiting);
    }
    mapper.update(trajectory_of(poses));
    EXPECT_GT(mapper.map().planes.size(), 1000u);
    std::set<int> ids;
    for (const MapPlane& plane : mapper.map().planes) EXPECT_TRUE(ids.insert(plane.id).second);
    for (const IntersectionLine& line : mapper.map().lines) {
        EXPECT_LT(line.plane_a, line.plane_b);
        EXPECT_TRUE(ids.contains(line.plane_a) && ids.contains(line.plane_b));
    }
}

TEST(MapOptions, NamesAllBadFields) {
    MapOptions options;
    options.merge_angle_deg = -1;
    options.outline_cell_m = kNan;
    try {
        const PlaneMapper mapper(options);
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("merge_angle_deg"));
        EXPECT_THAT(error.what(), HasSubstr("outline_cell_m"));
    }
}

/// Two keyframes that see a wall each, which get their ids in the order in which they come.
TEST(PlaneMapper, SurfacesGiveThePlanesOfAnotherMapperTheirIds) {
    Keyframe first = test::sample_keyframe(), second = test::sample_keyframe();
    first.regions = {test::sample_region()};
    second.regions = {test::sample_region(1)};
    second.id = first.id + 1;
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{first.id, first.utime, Pose::Identity()},
                            {second.id, second.utime, Pose::Identity()}};
    PlaneMapper one, other;
    one.update(trajectory);
    one.add(second);
    one.add(first);
    other.update(trajectory);
    other.add(first);
    other.add(second);
    ASSERT_EQ(one.map().planes.size(), 2u);
    ASSERT_EQ(other.map().planes.size(), 2u);
    const auto d_of = [](const PlaneMapper& mapper, std::size_t i) {
        return mapper.map().planes[i].center.z();
    };
    ASSERT_NE(d_of(one, 0), d_of(other, 0)) << "the test needs other ids";
    other.restore_ids(one.surfaces());
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(other.map().planes[i].id, one.map().planes[i].id);
        EXPECT_EQ(d_of(other, i), d_of(one, i));
    }
    Keyframe third = test::sample_keyframe();
    third.regions = {test::sample_region(2)};
    third.id = second.id + 1;
    other.add(third, Pose::Identity());
    EXPECT_EQ(other.map().planes.back().id, 2) << "no id twice";
}

/// A stop does not wait for all views; what only the others saw is unknown then, never free.
TEST(PlaneMapper, OfSeenSpaceAPartIsFoundWhereThereIsNoTimeForAll) {
    PlaneMapper mapper;
    for (int id = 0; id < 8; ++id) {
        const Pose world_from_camera = camera_at({3.0 * id, 0, 0});
        const Rectangle wall{facing({3.0 * id, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1.5, 1.5, {}};
        mapper.add(keyframe(id, {wall}, world_from_camera), world_from_camera);
    }
    const SeenSpace all = mapper.seen_space();
    ASSERT_GT(all.volume(), 0);
    EXPECT_EQ(mapper.seen_space([] { return true; }), all);
    EXPECT_TRUE(mapper.seen_space([] { return false; }).empty());
    int asked = 0;
    const SeenSpace part = mapper.seen_space([&] { return ++asked <= 2; });
    EXPECT_EQ(asked, 3);
    EXPECT_GT(part.volume(), 0);
    EXPECT_LT(part.volume(), all.volume());
    for (const SeenSpace::Block& block : part.blocks()) {
        const Eigen::Vector3d corner = SeenSpace::corner_of(block.at);
        for (int n = 0; n < 512; n += 7) {
            const Eigen::Vector3i voxel(n % 8, n / 8 % 8, n / 64);
            const Eigen::Vector3d p =
                corner + SeenSpace::kVoxel_m * (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5));
            EXPECT_TRUE(!part.is_free(p) || all.is_free(p));
        }
    }
}

}  // namespace
}  // namespace planemap::map
