// SPDX-License-Identifier: BSD-3-Clause
#include "messages/packed_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "messages/sample_messages.hpp"
#include "messages/varint.hpp"

namespace planemap::messages {
namespace {

/// What a vertex may be off at the most, metres.
constexpr double kMostOff_m = 0.005;

/// Any normal, any place in a building, a ring that reaches `reach` metres about its middle, and a hole.
MapPlane any_plane(int id, double reach, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> place(-40, 40), share(0.2, 1);
    PlanarRegion region = test::sample_region();
    const Eigen::Vector3d towards(normal(random), normal(random), normal(random));
    region.plane.normal = towards.normalized();
    const Eigen::Vector3d middle(place(random), place(random), place(random) / 8);
    region.plane.d = -region.plane.normal.dot(middle);
    region.box.frame_from_box.linear() =
        plane_axes(region.plane.normal, {normal(random), normal(random), normal(random)});
    region.box.frame_from_box.translation() = middle;
    Ring around, hole;
    const int vertices = 3 + static_cast<int>(random() % 40);
    for (int i = 0; i < vertices; ++i) {
        const double angle = 2 * std::numbers::pi * i / vertices;
        around.emplace_back(reach * share(random) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
        hole.emplace_back(0.1 * reach * Eigen::Vector2d(std::cos(angle), -std::sin(angle)));
    }
    region.outline.rings = {around, hole};
    return {id, region, static_cast<std::size_t>(random() % 1000)};
}

/// Any map, of planes whose outlines reach up to `reach` metres.
PlaneMap any_map(int planes, double reach, unsigned seed) {
    std::mt19937_64 random(seed);
    PlaneMap map;
    for (int i = 0; i < planes; ++i) {
        map.planes.push_back(any_plane(3 * i + static_cast<int>(random() % 3), reach, random));
        map.planes.back().label = static_cast<PlaneLabel>(random() % 7);
        map.planes.back().rms = static_cast<float>(random() % 1000) * 3e-5f;
        map.planes.back().inliers = static_cast<float>(3 + random() % (1u << (1 + i % 30)));
    }
    return map;
}

PlaneMap there_and_back(const PlaneMap& map) {
    PlaneMap back;
    unpack_map(packed_map(map, kMapStep_m), kMapStep_m, back);
    return back;
}

/// World positions of the vertices of an outline of the plane.
std::vector<Eigen::Vector3d> vertices_of(const MapPlane& plane, const MapOutline& outline) {
    std::vector<Eigen::Vector3d> all;
    for (const Ring& ring : outline.rings().rings)
        for (const Eigen::Vector2d& v : ring)
            all.emplace_back(plane.world_from_plane() * Eigen::Vector3d(v.x(), v.y(), 0));
    return all;
}

double farthest_moved(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, (a[i] - b[i]).norm());
    return farthest;
}

/// The property that the format promises, for planes of any size up to 80 m about their middle.
TEST(PackedMap, NoVertexMovesByMoreThan5Millimetres) {
    double farthest = 0;
    for (const double reach : {0.05, 0.5, 5.0, 30.0, 79.0}) {
        for (unsigned seed = 0; seed < 20; ++seed) {
            const PlaneMap map = any_map(20, reach, seed), back = there_and_back(map);
            ASSERT_EQ(back.planes.size(), map.planes.size());
            for (std::size_t i = 0; i < map.planes.size(); ++i) {
                const MapPlane &a = map.planes[i], &b = back.planes[i];
                const double moved = farthest_moved(vertices_of(a, a.outline), vertices_of(b, b.outline));
                ASSERT_LE(moved, kMostOff_m) << "reach " << reach << ", seed " << seed << ", plane " << i;
                farthest = std::max(farthest, moved);
            }
        }
    }
    EXPECT_GT(farthest, 0.0025) << "or it is not lossy at all";
}

TEST(PackedMap, APlaneLiesWhereItLay) {
    const PlaneMap map = any_map(200, 3, 1), back = there_and_back(map);
    for (std::size_t i = 0; i < map.planes.size(); ++i) {
        const MapPlane &a = map.planes[i], &b = back.planes[i];
        EXPECT_EQ(b.id, a.id);
        EXPECT_EQ(b.label, a.label);
        EXPECT_EQ(b.keyframes, a.keyframes);
        EXPECT_LT((a.normal - b.normal).norm(), 3e-5f);
        EXPECT_LT(std::abs(a.plane().signed_distance(b.center.cast<double>())), 3.5e-4);
        EXPECT_NEAR(b.rms, a.rms, 5.1e-5);
        EXPECT_NEAR(b.inliers / a.inliers, 1, 0.002);
        if (a.inliers <= 511) {
            EXPECT_EQ(b.inliers, a.inliers);
        }
    }
}

/// What is not sent: the box is around the outline along the same axes, and the area the outline's.
TEST(PackedMap, BoxAndAreaFollowFromTheOutline) {
    const PlaneMap map = any_map(50, 2, 2), back = there_and_back(map);
    for (std::size_t i = 0; i < map.planes.size(); ++i) {
        const MapPlane &a = map.planes[i], &b = back.planes[i];
        EXPECT_NEAR(b.area, area(b.outline.rings()), 1e-6 * (1 + area(b.outline.rings())));
        EXPECT_NEAR(b.area, a.area, 0.02 * a.area + 0.01);
        const Eigen::Vector3d x_a = a.world_from_plane().linear().col(0),
                              x_b = b.world_from_plane().linear().col(0);
        EXPECT_LT((x_a - x_b).norm(), 3e-4);
        Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
        for (const Ring& ring : b.outline.rings().rings) {
            for (const Eigen::Vector2d& v : ring) {
                low = low.cwiseMin(v);
                high = high.cwiseMax(v);
            }
        }
        EXPECT_LT((low + high).norm(), 1e-6) << "the box's centre is the outline's middle";
        EXPECT_LT((0.5 * (high - low) - b.half_extents.cast<double>()).norm(), 1e-6);
    }
}

/// Of the centre that is not sent: what was about it stays where it was, further out than 16 bits of half
/// steps, too.
TEST(PackedMap, LargePlanesLoseNoMoreThanTheyDoInMemory) {
    std::mt19937_64 random(3);
    PlaneMap map;
    map.planes.push_back(any_plane(1, 400, random));
    const PlaneMap back = there_and_back(map);
    const MapPlane &a = map.planes[0], &b = back.planes[0];
    EXPECT_LE(farthest_moved(vertices_of(a, a.outline), vertices_of(b, b.outline)), 0.03)
        << "at 400 m a step is 12 mm in memory";
}

/// A map that is read and written any number of times is lossy once.
TEST(PackedMap, TheSecondTimeItIsTheSameBytes) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const std::vector<std::uint8_t> once = packed_map(any_map(100, 4, seed), kMapStep_m);
        PlaneMap map;
        unpack_map(once, kMapStep_m, map);
        EXPECT_EQ(packed_map(map, kMapStep_m), once);
    }
}

TEST(PackedMap, NormalsAlongTheAxesAndTheFoldsOfTheOctahedronComeBack) {
    PlaneMap map;
    int id = 0;
    for (const double x : {-1.0, -1e-7, 0.0, 1e-7, 1.0})
        for (const double y : {-1.0, -1e-7, 0.0, 1e-7, 1.0})
            for (const double z : {-1.0, -1e-7, 0.0, 1e-7, 1.0}) {
                const Eigen::Vector3d normal(x, y, z);
                if (normal.norm() < 0.5) continue;
                PlanarRegion region = test::sample_region();
                region.plane.normal = normal.normalized();
                region.plane.d = -2;
                region.box.frame_from_box.linear() = plane_axes(region.plane.normal, {0.3, 0.5, -0.7});
                region.box.frame_from_box.translation() = 2 * region.plane.normal;
                map.planes.emplace_back(id++, region, 1);
            }
    const PlaneMap back = there_and_back(map);
    for (std::size_t i = 0; i < map.planes.size(); ++i) {
        const MapPlane &a = map.planes[i], &b = back.planes[i];
        EXPECT_LT((a.normal - b.normal).norm(), 3e-5f) << a.normal.transpose();
        EXPECT_LE(farthest_moved(vertices_of(a, a.outline), vertices_of(b, b.outline)), kMostOff_m);
    }
}

TEST(PackedMap, LinesAndPointsComeBack) {
    PlaneMap map;
    const Eigen::Vector3d corner(11, -4, 2.5);
    const Eigen::Vector3d normals[] = {{1, 0.1, 0}, {-0.2, 1, 0.1}, {0, 0.05, 1}};
    for (int id = 0; id < 3; ++id) {
        PlanarRegion region = test::sample_region();
        region.plane.normal = normals[id].normalized();
        region.plane.d = -region.plane.normal.dot(corner);
        region.box.frame_from_box.linear() = plane_axes(region.plane.normal, Eigen::Vector3d(1, 1, 1));
        region.box.frame_from_box.translation() =
            corner + region.box.frame_from_box.linear() * Eigen::Vector3d(1.5, 0.7, 0);
        map.planes.emplace_back(5 * id + 2, region, 1);
    }
    const Eigen::Vector3f along = map.planes[0].normal.cross(map.planes[1].normal).normalized();
    const Eigen::Vector3f at = corner.cast<float>();
    map.lines.push_back({2, 7, at - 0.3f * along, at + 2.0f * along});
    map.points.push_back({{2, 7, 12}, at});
    const PlaneMap back = there_and_back(map);
    ASSERT_EQ(back.lines.size(), 1u);
    EXPECT_EQ(back.lines[0].plane_a, 2);
    EXPECT_EQ(back.lines[0].plane_b, 7);
    EXPECT_LT((back.lines[0].from - map.lines[0].from).norm(), 0.005f);
    EXPECT_LT((back.lines[0].to - map.lines[0].to).norm(), 0.005f);
    ASSERT_EQ(back.points.size(), 1u);
    EXPECT_EQ(back.points[0].planes, map.points[0].planes);
    EXPECT_LT((back.points[0].position - at).norm(), 0.002f);
    map.lines[0].plane_b = 2;  // with itself: there is no such line
    EXPECT_TRUE(there_and_back(map).lines.empty());
}

TEST(PackedMap, InferredPartsComeBackWhereTheyWere) {
    PlaneMap map = any_map(3, 2, 5);
    const Outline part{{{{0, 0}, {40, 0}, {40, 1.5}, {0, 1.5}}, {{1, 0.5}, {1, 1}, {2, 1}}}};
    map.inferred = {{map.planes[0].id, MapOutline(part)}, {map.planes[2].id, MapOutline(part)}};
    const PlaneMap back = there_and_back(map);
    ASSERT_EQ(back.inferred.size(), 2u);
    EXPECT_EQ(back.inferred_of(map.planes[1].id), nullptr);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(back.inferred[i].plane, map.inferred[i].plane);
        const MapPlane &a = *map.find(map.inferred[i].plane), &b = *back.find(map.inferred[i].plane);
        EXPECT_LE(
            farthest_moved(vertices_of(a, map.inferred[i].outline), vertices_of(b, back.inferred[i].outline)),
            kMostOff_m)
            << "40 m from the middle, too";
    }
    PlaneMap plain = map;
    plain.inferred.clear();
    for (std::size_t i = 0; i < map.planes.size(); ++i)
        EXPECT_EQ(back.planes[i].area, there_and_back(plain).planes[i].area) << "they count in no area";
}

TEST(PackedMap, TakesFewBytes) {
    for (const double reach : {0.3, 3.0}) {
        const PlaneMap map = any_map(40, reach, 6);
        std::size_t vertices = 0, rings = 0;
        for (const MapPlane& plane : map.planes) {
            vertices += plane.outline.vertex_count();
            rings += plane.outline.ring_count();
        }
        EXPECT_LE(packed_map(map, kMapStep_m).size(), 4 + 24 * map.planes.size() + 4 * rings + 4 * vertices);
    }
    EXPECT_EQ(packed_map(PlaneMap(), kMapStep_m).size(), 4u);
}

TEST(PackedMap, OfWhatIsNotFiniteSomethingFiniteIsSent) {
    const float none = std::numeric_limits<float>::quiet_NaN(),
                endless = std::numeric_limits<float>::infinity();
    for (const float bad : {none, endless, -endless, 1e30f, -1e30f}) {
        PlaneMap map = any_map(1, 1, 7);
        map.planes[0].rms = map.planes[0].inliers = bad;
        map.planes[0].center.x() = bad;
        map.planes[0].outline.unit = bad;
        const MapPlane plane = there_and_back(map).planes.at(0);
        EXPECT_TRUE(plane.center.allFinite() && plane.normal.allFinite() && std::isfinite(plane.rms));
        EXPECT_GE(plane.inliers, 3);
    }
    PlaneMap map = any_map(1, 1, 7);
    map.planes[0].outline = {};
    EXPECT_TRUE(there_and_back(map).planes.at(0).outline.empty())
        << "nor is there an outline where there is none";
}

/// The bytes of a map of one plane, made by hand, that `spoil` changed.
class ByHand {
  public:
    std::uint64_t planes = 1, label = 1, rms = 10, inliers = 300, keyframes = 2, rings = 1, size = 3;
    std::int64_t id = 0, u = 0, d = 100, angle = 5, x = 40;
    std::uint64_t lines = 0, line_plane = 0, points = 0, point_plane = 0, inferred = 0, inferred_plane = 0;
    int trailing = 0;

    std::vector<std::uint8_t> bytes() const {
        VarintWriter out;
        out.put(planes);
        out.put_signed(id);
        out.put(label);
        for (const std::int64_t s : {u, std::int64_t{0}, d, angle}) out.put_signed(s);
        for (const std::uint64_t n : {rms, inliers, keyframes}) out.put(n);
        put_rings(out);
        out.put(lines);
        for (int i = 0; i < 4 && lines > 0; ++i) out.put(line_plane);
        out.put(points);
        for (int i = 0; i < 3 && points > 0; ++i) out.put(point_plane);
        out.put(inferred);
        for (std::uint64_t i = 0; i < inferred && i < 2; ++i) {
            out.put(inferred_plane);
            put_rings(out);
        }
        for (int i = 0; i < trailing; ++i) out.put(0);
        return out.take();
    }

  private:
    void put_rings(VarintWriter& out) const {
        out.put(rings);
        out.put(size);
        for (const std::int64_t s :
             {x, std::int64_t{0}, std::int64_t{0}, std::int64_t{30}, -x, std::int64_t{0}})
            out.put_signed(s);
    }
};

TEST(PackedMap, BytesByHandAreWhatTheFormatSays) {
    PlaneMap map;
    unpack_map(ByHand().bytes(), 0.01f, map);
    ASSERT_EQ(map.planes.size(), 1u);
    const MapPlane& plane = map.planes[0];
    EXPECT_EQ(plane.id, 0);
    EXPECT_EQ(plane.label, PlaneLabel::kFloor);
    EXPECT_EQ(plane.normal, Eigen::Vector3f(0, 0, 1));
    EXPECT_NEAR(plane.plane().d, 0.05, 1e-6);
    EXPECT_NEAR(plane.angle, 5 * std::numbers::pi / 8192, 1e-6);
    EXPECT_NEAR(plane.rms, 0.001, 1e-7);
    EXPECT_EQ(plane.inliers, 300);
    EXPECT_EQ(plane.keyframes, 2);
    EXPECT_NEAR(plane.area, 0.5 * 0.4 * 0.3, 1e-6);  // (40, 0), (40, 30), (0, 30) in steps of 1 cm
    EXPECT_NEAR(plane.half_extents.x(), 0.2, 1e-6);
    EXPECT_NEAR(plane.half_extents.y(), 0.15, 1e-6);
    ByHand large;
    large.inliers = 20 << 9 | 256;
    unpack_map(large.bytes(), 0.01f, map);
    EXPECT_EQ(map.planes.at(0).inliers, 256.0f * 1048576.0f);
}

TEST(PackedMap, WhatMakesNoSenseIsRefused) {
    const auto refused = [](const char* what, auto spoil) {
        ByHand map;
        spoil(map);
        PlaneMap out;
        EXPECT_THROW(unpack_map(map.bytes(), 0.005f, out), MessageError) << what;
    };
    refused("more planes than bytes", [](ByHand& m) { m.planes = 1u << 30; });
    refused("two planes of one", [](ByHand& m) { m.planes = 2; });
    refused("an id beyond 31 bits", [](ByHand& m) { m.id = std::int64_t{1} << 31; });
    refused("a label that is none", [](ByHand& m) { m.label = 7; });
    refused("a normal off the octahedron", [](ByHand& m) { m.u = 65537; });
    refused("a plane beyond 300 km", [](ByHand& m) { m.d = std::int64_t{1} << 40; });
    refused("an angle of more than half a turn", [](ByHand& m) { m.angle = 8193; });
    refused("scatter of 300 km", [](ByHand& m) { m.rms = std::uint64_t{1} << 40; });
    refused("fewer than three inliers", [](ByHand& m) { m.inliers = 2; });
    refused("inliers beyond floats", [](ByHand& m) { m.inliers = 200 << 9 | 300; });
    refused("too many keyframes", [](ByHand& m) { m.keyframes = 32768; });
    refused("more rings than bytes", [](ByHand& m) { m.rings = 100; });
    refused("a ring of two", [](ByHand& m) { m.size = 2; });
    refused("a ring longer than its bytes", [](ByHand& m) { m.size = 1000; });
    refused("a vertex beyond 300 km", [](ByHand& m) { m.x = std::int64_t{1} << 30; });
    refused("a line of no plane", [](ByHand& m) { m.lines = 1, m.line_plane = 1; });
    refused("a line of a plane with itself", [](ByHand& m) { m.lines = 1; });
    refused("a point of no plane", [](ByHand& m) { m.points = 1, m.point_plane = 9; });
    refused("a point of a plane with itself", [](ByHand& m) { m.points = 1; });
    refused("something inferred of no plane", [](ByHand& m) { m.inferred = 1, m.inferred_plane = 1; });
    refused("something inferred twice", [](ByHand& m) { m.inferred = 2; });
    refused("bytes too many", [](ByHand& m) { m.trailing = 1; });
    PlaneMap out;
    for (const float unit : {0.0f, -1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_THROW(unpack_map(ByHand().bytes(), unit, out), MessageError) << unit;
    const std::vector<std::uint8_t> whole = ByHand().bytes();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(unpack_map(std::span(whole).first(size), 0.005f, out), MessageError) << size;
}

TEST(PackedMap, SurvivesSpoiltAndRandomBytes) {
    const std::vector<std::uint8_t> good = packed_map(test::sample_map(), kMapStep_m);
    const auto take = [](const std::vector<std::uint8_t>& bytes) {
        PlaneMap map;
        try {
            unpack_map(bytes, kMapStep_m, map);
            there_and_back(map);
        } catch (const MessageError&) {
        }
    };
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const int hostile : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            std::vector<std::uint8_t> bad = good;
            bad[i] = static_cast<std::uint8_t>(hostile);
            take(bad);
        }
    }
    std::mt19937_64 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::uint8_t> noise(random() % 300);
        for (std::uint8_t& byte : noise)
            byte = static_cast<std::uint8_t>(random() % (round % 2 == 0 ? 256 : 12));
        take(noise);
    }
}

TEST(Varint, NumbersComeBack) {
    const std::uint64_t numbers[] = {0, 1, 127, 128, 16383, 16384, (std::uint64_t{1} << 49) - 1};
    const std::int64_t wholes[] = {0, -1, 1, 63, -64, 64, -(std::int64_t{1} << 40)};
    VarintWriter out;
    for (const std::uint64_t n : numbers) out.put(n);
    for (const std::int64_t n : wholes) out.put_signed(n);
    const std::vector<std::uint8_t> bytes = out.take();
    EXPECT_EQ(bytes.size(), 1u + 1 + 1 + 2 + 2 + 3 + 7 + 1 + 1 + 1 + 1 + 1 + 2 + 6);
    VarintReader in(bytes);
    for (const std::uint64_t n : numbers) EXPECT_EQ(in.get("n"), n);
    for (const std::int64_t n : wholes) EXPECT_EQ(in.get_signed("n"), n);
    EXPECT_EQ(in.left(), 0u);
    EXPECT_THROW(in.get("n"), MessageError);
    const std::vector<std::uint8_t> endless(20, 0xff);
    EXPECT_THROW(VarintReader(endless).get("n"), MessageError);
}

}  // namespace
}  // namespace planemap::messages
