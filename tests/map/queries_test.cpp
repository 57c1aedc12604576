// SPDX-License-Identifier: BSD-3-Clause
#include "map/queries.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/furniture.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::level;
using scene::Rectangle;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep = 0.04;  // between the samples that answers are compared with

PlaneMap random_map(test::Random& random, int planes) {
    std::vector<Rectangle> rectangles;
    for (int i = 0; i < planes; ++i) {
        Rectangle r{random.pose(2), random.uniform(0.2, 1.2), random.uniform(0.2, 0.8), {}};
        const double x = random.uniform(0.1, 0.9) * r.half_x, y = random.uniform(0.1, 0.9) * r.half_y;
        if (i % 2 == 0) r.holes.push_back(scene::rectangle_ring(-x, -y, 0.5 * x, y));
        rectangles.push_back(r);
    }
    return scene::map_of(rectangles);
}

/// Points inside the plane's outline, less than kStep apart.
std::vector<Eigen::Vector3d> interior(const MapPlane& plane) {
    const Outline outline = plane.outline.rings();
    const Pose world_from_plane = plane.world_from_plane();
    std::vector<Eigen::Vector3d> points;
    for (double x = -1.5; x < 1.5; x += 0.7 * kStep)
        for (double y = -1.5; y < 1.5; y += 0.7 * kStep)
            if (contains(outline, {x, y})) points.push_back(world_from_plane * Eigen::Vector3d(x, y, 0));
    return points;
}

/// The same with points on the border.
std::vector<Eigen::Vector3d> samples(const MapPlane& plane) {
    std::vector<Eigen::Vector3d> points = interior(plane);
    const Pose world_from_plane = plane.world_from_plane();
    for (const Ring& ring : plane.outline.rings().rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Eigen::Vector2d a = ring[i], b = ring[(i + 1) % ring.size()];
            for (double s = 0; s < 1; s += 0.7 * kStep / (b - a).norm()) {
                const Eigen::Vector2d p = a + s * (b - a);
                points.push_back(world_from_plane * Eigen::Vector3d(p.x(), p.y(), 0));
            }
        }
    }
    return points;
}

std::vector<std::vector<Eigen::Vector3d>> samples(const PlaneMap& map) {
    std::vector<std::vector<Eigen::Vector3d>> all;
    for (const MapPlane& plane : map.planes) all.push_back(samples(plane));
    return all;
}

TEST(Nearest, IsTheNearestOfAllPoints) {
    test::Random random(1);
    const PlaneMap map = random_map(random, 12);
    const MapQueries queries(map);
    const auto all = samples(map);
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d p = random.vector(3);
        double brute = kInfinity;
        for (const auto& points : all)
            for (const auto& q : points) brute = std::min(brute, (p - q).norm());
        const auto nearest = queries.nearest(p);
        ASSERT_TRUE(nearest);
        EXPECT_LE(nearest->distance, brute + 1e-9);
        EXPECT_GE(nearest->distance, brute - kStep);
        EXPECT_NEAR((p - nearest->point).norm(), nearest->distance, 1e-9);
        EXPECT_NEAR(distance(*map.find(nearest->id), nearest->point), 0, 1e-9);
        for (const MapPlane& plane : map.planes) EXPECT_GE(distance(plane, p), nearest->distance - 1e-9);
        EXPECT_EQ(queries.nearest(p, nearest->distance + 1e-9)->id, nearest->id);
        EXPECT_FALSE(queries.nearest(p, nearest->distance - 1e-9));
    }
}

TEST(Touching, FindsWhatHasAPointInTheBox) {
    test::Random random(2);
    const PlaneMap map = random_map(random, 30);
    const MapQueries queries(map);
    const auto all = samples(map);
    int touching = 0;
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d centre = random.vector(2), half = random.vector(0.4).cwiseAbs();
        const Eigen::AlignedBox3d box(centre - half, centre + half);
        const std::vector<int> ids = queries.touching(box);
        EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
        for (const MapPlane& plane : map.planes) {
            double nearest = kInfinity;
            for (const auto& p : all[static_cast<std::size_t>(plane.id)])
                nearest = std::min(nearest, box.exteriorDistance(p));
            const bool found = std::count(ids.begin(), ids.end(), plane.id) == 1;
            EXPECT_TRUE(found || nearest > 0);
            EXPECT_TRUE(!found || nearest < kStep);
            touching += found;
        }
    }
    EXPECT_GT(touching, 100);
}

TEST(Touching, LooksThroughHolesAndOnTheFace) {
    const PlaneMap map = scene::map_of({{scene::facing({0, 0, 1}, {0, 0, 1}, {1, 0, 0}),
                                         1,
                                         1,
                                         {scene::rectangle_ring(-0.5, -0.5, 0.5, 0.5)}}});
    const MapQueries queries(map);
    using Box = Eigen::AlignedBox3d;
    using Eigen::Vector3d;
    EXPECT_THAT(queries.touching(Box(Vector3d(-0.4, -0.4, 0), Vector3d(0.4, 0.4, 2))), IsEmpty());
    EXPECT_THAT(queries.touching(Box(Vector3d(-0.4, -0.4, 0), Vector3d(0.6, 0.4, 2))), ElementsAre(0));
    EXPECT_THAT(queries.touching(Box(Vector3d(0.6, 0.6, 0), Vector3d(0.7, 0.7, 2))), ElementsAre(0))
        << "within";
    EXPECT_THAT(queries.touching(Box(Vector3d(0.6, 0.6, 1), Vector3d(0.7, 0.7, 1))), ElementsAre(0))
        << "flat";
    EXPECT_THAT(queries.touching(Box(Vector3d(-5, -5, -5), Vector3d(5, 5, 5))), ElementsAre(0))
        << "all of it";
    EXPECT_THAT(queries.touching(Box(Vector3d(-5, -5, 1.01), Vector3d(5, 5, 5))), IsEmpty());
    EXPECT_THAT(queries.touching(Box()), IsEmpty());
}

TEST(Cast, MeetsTheFirstPlane) {
    test::Random random(3);
    const PlaneMap map = random_map(random, 12);
    const MapQueries queries(map);
    for (const MapPlane& plane : map.planes) {
        const std::vector<Eigen::Vector3d> points = interior(plane);
        for (std::size_t i = 0; i < points.size(); i += 97) {
            const Eigen::Vector3d origin = random.vector(3), direction = points[i] - origin;
            const auto hit = queries.cast(origin, random.uniform(0.1, 5) * direction);
            ASSERT_TRUE(hit);
            EXPECT_LE(hit->range, direction.norm() + 1e-9);
            EXPECT_LT((origin + hit->range * direction.normalized() - hit->point).norm(), 1e-9);
            const MapPlane& first = *map.find(hit->id);
            EXPECT_NEAR(distance(first, hit->point), 0, 1e-9);
            EXPECT_EQ(hit->from_front, first.plane().signed_distance(origin) > 0);
            // No other plane is crossed before.
            for (const MapPlane& other : map.planes) {
                const double d0 = other.plane().signed_distance(origin),
                             d1 = other.plane().signed_distance(hit->point);
                if (other.id == hit->id || d0 * d1 > 0) continue;
                EXPECT_GT(distance(other, origin + d0 / (d0 - d1) * (hit->point - origin)), 0);
            }
            EXPECT_FALSE(queries.cast(origin, direction, hit->range - 1e-6));
        }
    }
}

TEST(Cast, PassesThroughHolesAndBesideAlongOrBehind) {
    const PlaneMap map = scene::map_of({{scene::facing({0, 0, 1}, {0, 0, 1}, {1, 0, 0}),
                                         1,
                                         1,
                                         {scene::rectangle_ring(-0.5, -0.5, 0.5, 0.5)}}});
    const MapQueries queries(map);
    EXPECT_FALSE(queries.cast({0, 0, 0}, {0, 0, 1}));
    EXPECT_FALSE(queries.cast({2, 0, 0}, {0, 0, 1}));
    EXPECT_FALSE(queries.cast({0.7, 0, 0}, {0, 0, -1}));
    EXPECT_FALSE(queries.cast({-3, 0.7, 1}, {1, 0, 0}));
    const auto hit = queries.cast({0.7, 0, 0}, {0, 0, 3});
    ASSERT_TRUE(hit);
    EXPECT_FALSE(hit->from_front);
    EXPECT_DOUBLE_EQ(hit->range, 1);
}

TEST(FreeHeight, IsUpToTheTableOrTheCeiling) {
    test::Random random(4);
    for (int i = 0; i < 10; ++i) {
        const Pose world_from_room = random.pose();
        PlaneMap map = scene::map_of(
            {level(0, 0, 0, 3, 2), level(1, 1, 0.75, 0.5, 0.5), level(-2, 0, 2.5, 1, 2)}, world_from_room);
        EXPECT_FALSE(MapQueries(map).free_height(world_from_room.translation())) << "up is not known";
        map.up = world_from_room.linear().col(2).cast<float>();
        const MapQueries queries(map);
        const auto height = [&](double x, double y, double z) {
            return queries.free_height(world_from_room * Eigen::Vector3d(x, y, z)).value();
        };
        EXPECT_NEAR(height(1, 1, 0).hit->range, 0.75, 1e-4);
        EXPECT_NEAR(height(1, 1, -0.02).hit->range, 0.77, 1e-4) << "a point a little below the floor";
        EXPECT_NEAR(height(-2, 0, 0).hit->range, 2.5, 1e-4);
        EXPECT_FALSE(height(0.4, 0, 0).hit);
        EXPECT_EQ(height(0.4, 0, 0).end, Place::kUnknown) << "nobody looked there";
    }
}

/// Voxels of a box that is aligned to blocks, all of them free.
SeenSpace free_box(const std::array<int, 3>& low, const std::array<int, 3>& high) {
    std::vector<SeenSpace::Block> blocks;
    for (int z = low[2]; z < high[2]; ++z) {
        for (int y = low[1]; y < high[1]; ++y) {
            for (int x = low[0]; x < high[0]; ++x) {
                SeenSpace::Block& block = blocks.emplace_back();
                block.at = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                            static_cast<std::int16_t>(z)};
                block.free.fill(~std::uint64_t{0});
            }
        }
    }
    return SeenSpace(blocks);
}

/// A floor, a table at 0.8 m over a part of it, a ceiling at 2.6 m over another; free from -1.6 to 1.6 m and
/// up to 2.4 m, but above 1.6 m only where x > 0.
MapQueries room_with_seen_space() {
    PlaneMap map = scene::map_of(
        {level(0, 0, 0, 3, 3), level(1, 1, 0.8, 0.5, 0.5), scene::facing_down(level(-1, 0, 2.6, 1, 3))});
    map.up = Eigen::Vector3f::UnitZ();
    std::vector<SeenSpace::Block> blocks = free_box({-2, -2, 0}, {2, 2, 2}).blocks();
    const SeenSpace above = free_box({0, -2, 2}, {2, 2, 3});
    blocks.insert(blocks.end(), above.blocks().begin(), above.blocks().end());
    return MapQueries(map, SeenSpace(blocks));
}

TEST(StateAt, TellsFreeOccupiedAndUnknownApart) {
    const MapQueries queries = room_with_seen_space();
    EXPECT_EQ(queries.state_at({0, 0, 1}), Place::kFree);
    EXPECT_EQ(queries.state_at({1, 1, 0.82}), Place::kOccupied) << "the table, though a voxel says free";
    EXPECT_EQ(queries.state_at({1, 1, 0.76}), Place::kOccupied);
    EXPECT_EQ(queries.state_at({-1, 0, 2}), Place::kUnknown);
    EXPECT_EQ(queries.state_at({-1, 0, 2.45}), Place::kFree) << "the ceiling was seen through that";
    EXPECT_EQ(queries.state_at({-1, 0, 2.7}), Place::kUnknown) << "above the ceiling";
    EXPECT_EQ(queries.state_at({2.5, 2.5, 0.2}), Place::kFree) << "right above the floor";
    EXPECT_EQ(queries.state_at({2.5, 2.5, 0.3}), Place::kUnknown);
    EXPECT_EQ(queries.state_at({2.5, 2.5, -0.2}), Place::kUnknown);
    EXPECT_EQ(queries.state_at({kInfinity, 0, 0}), Place::kUnknown);
}

TEST(LookAlong, EndsAtAPlaneAtWhatNobodySawOrAtTheLargestRange) {
    const MapQueries queries = room_with_seen_space();
    const auto down = queries.look_along({1, 1, 2}, {0, 0, -3}).value();
    EXPECT_EQ(down.end, Place::kOccupied);
    EXPECT_NEAR(down.free, 1.2, 1e-6);
    EXPECT_EQ(down.hit->id, 1);
    const auto aside = queries.look_along({0, 0, 1}, {1, 0, 0}).value();
    EXPECT_EQ(aside.end, Place::kUnknown);
    EXPECT_NEAR(aside.free, 1.6, 0.051);
    EXPECT_FALSE(aside.hit);
    const auto near = queries.look_along({0, 0, 1}, {1, 0, 0}, 1).value();
    EXPECT_EQ(near.end, Place::kFree);
    EXPECT_DOUBLE_EQ(near.free, 1);
    EXPECT_EQ(queries.look_along({0, 0, 9}, {0, 0, 1}).value().free, 0);
    const auto none = queries.look_along({0, 0, 1}, {1, 0, 0}, 0).value();
    EXPECT_EQ(none.free, 0);
    EXPECT_EQ(none.end, Place::kFree);
    EXPECT_FALSE(queries.look_along({0, 0, 1}, {0, 0, 0}));
    EXPECT_FALSE(queries.look_along({0, 0, 1}, {kInfinity, 0, 0}));
    EXPECT_FALSE(queries.look_along({0, 0, 1}, {1, 0, 0}, -1));
}

TEST(FreeHeight, IsNotFreeWhereNobodySaw) {
    const MapQueries queries = room_with_seen_space();
    const auto below_ceiling = queries.free_height({-1, 0, 0}).value();
    EXPECT_EQ(below_ceiling.end, Place::kUnknown);
    EXPECT_NEAR(below_ceiling.free, 1.6, 0.051);
    EXPECT_NEAR(below_ceiling.hit->range, 2.6, 1e-4) << "what is behind it is known all the same";
    const auto open = queries.free_height({0.4, 0, 0}).value();
    EXPECT_EQ(open.end, Place::kUnknown) << "no ceiling was seen, and nothing above 2.4 m";
    EXPECT_NEAR(open.free, 2.4, 0.051);
    const auto table = queries.free_height({1, 1, 0}).value();
    EXPECT_EQ(table.end, Place::kOccupied);
    EXPECT_NEAR(table.free, 0.8, 1e-4);
}

TEST(Gap, IsTheSmallestDistanceOfAllPairsOfPoints) {
    test::Random random(5);
    const PlaneMap map = random_map(random, 10);
    const MapQueries queries(map);
    int crossing = 0, apart = 0;
    for (const MapPlane& a : map.planes) {
        const auto points = samples(a);
        for (const MapPlane& b : map.planes) {
            double brute = kInfinity;
            for (const auto& p : points) brute = std::min(brute, distance(b, p));
            const double gap = queries.gap(a.id, b.id).value();
            EXPECT_LE(gap, brute + 1e-9);
            EXPECT_GE(gap, brute - kStep);
            EXPECT_NEAR(gap, queries.gap(b.id, a.id).value(), 1e-9);
            ++(gap == 0 ? crossing : apart);
        }
    }
    EXPECT_GT(crossing, 7);
    EXPECT_GT(apart, 7);
    EXPECT_FALSE(queries.gap(0, 99));
}

TEST(MapQueries, OfDegenerateMaps) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    const MapQueries empty(PlaneMap{});
    EXPECT_FALSE(empty.nearest(zero));
    EXPECT_FALSE(empty.cast(zero, {0, 0, 1}));
    EXPECT_FALSE(empty.free_height(zero));
    EXPECT_FALSE(empty.gap(0, 0));

    PlaneMap map = scene::map_of(
        {level(0, 0, 0, 1, 1), level(0, 0, 1, 1, 1), level(0, 0, 2, 1, 1), level(0, 0, 3, 1, 1)});
    map.planes[0].normal.setConstant(std::numeric_limits<float>::quiet_NaN());
    map.planes[1].outline = {};
    map.planes[2].center.setConstant(std::numeric_limits<float>::infinity());
    const MapQueries queries(map);
    EXPECT_EQ(queries.nearest(zero)->id, 3);
    EXPECT_EQ(queries.cast(zero, {0, 0, 1})->id, 3);
    EXPECT_FALSE(queries.gap(2, 3));
    EXPECT_FALSE(queries.nearest({nan, 0, 0}));
    EXPECT_FALSE(queries.cast({nan, 0, 0}, {0, 0, 1}));
    EXPECT_FALSE(queries.cast(zero, {0, 0, nan}));
    EXPECT_FALSE(queries.cast(zero, zero));
    EXPECT_THAT(
        queries.touching(Eigen::AlignedBox3d(Eigen::Vector3d::Constant(nan), Eigen::Vector3d::Constant(9))),
        IsEmpty());
}

}  // namespace
}  // namespace planemap::map
