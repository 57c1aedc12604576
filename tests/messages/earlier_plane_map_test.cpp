// SPDX-License-Identifier: BSD-3-Clause
// Maps as they were sent and stored before they were packed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::messages {
namespace {

using test::encoded;
using test::sample_earlier_map;

TEST(EarlierPlaneMap, ItsFingerprintsAreThoseOfStoredFiles) {
    EXPECT_EQ(fingerprints<earlier_plane_map_t>(),
              (std::vector<std::uint64_t>{0x384b84be8e03e896, 0x890cd1fe3f86f0fa, 0xad69623d7bd0a548}));
    EXPECT_EQ(static_cast<std::uint64_t>(earlier_map_plane_t::getHash()), 0x783e0d562cdf171eu);
}

TEST(EarlierPlaneMap, IsReadAsItIs) {
    const PlaneMap map = plane_map_from(encoded(sample_earlier_map()));
    EXPECT_EQ(map.utime, 5);
    EXPECT_EQ(map.revision, 6);
    EXPECT_EQ(map.up, Eigen::Vector3f(0, 0, 1));
    ASSERT_EQ(map.planes.size(), 2u);
    const MapPlane& plane = map.planes[1];
    EXPECT_EQ(plane.id, 4);
    EXPECT_EQ(plane.label, PlaneLabel::kWall);
    EXPECT_EQ(plane.normal, Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(plane.center, Eigen::Vector3f(0, 2, 0));
    EXPECT_EQ(plane.half_extents, Eigen::Vector2f(0.5f, 0.5f));
    EXPECT_EQ(plane.rms, 0.01f);
    EXPECT_EQ(plane.inliers, 1000);
    EXPECT_EQ(plane.area, 1);
    EXPECT_EQ(plane.keyframes, 3);
    EXPECT_EQ(plane.outline.unit, 0.001f);
    EXPECT_EQ(plane.outline.packed,
              (std::vector<std::int16_t>{4, -500, -500, 500, -500, 500, 500, -500, 500}));
    ASSERT_EQ(map.lines.size(), 1u);
    EXPECT_EQ(map.lines[0].plane_b, 4);
    EXPECT_LT((map.lines[0].from - Eigen::Vector3f(2, 2, -0.5f)).norm(), 1e-5f);
    EXPECT_LT((map.lines[0].to - Eigen::Vector3f(2, 2, 0.25f)).norm(), 1e-5f);
    ASSERT_NE(map.inferred_of(4), nullptr);
    EXPECT_EQ(map.inferred_of(4)->vertex_count(), 3u);
}

TEST(EarlierPlaneMap, AMapOfTodayIsReadByTheSameCall) {
    const PlaneMap map = plane_map_from(encoded(to_message(test::sample_map(), 1)));
    EXPECT_EQ(map.planes.size(), 3u);
    EXPECT_THROW(plane_map_from(encoded(to_message(test::sample_trajectory(), 1))), OtherTypeError);
}

TEST(EarlierPlaneMap, WhatMakesNoSenseIsRefused) {
    const auto refused = [](auto spoil) {
        earlier_plane_map_t message = sample_earlier_map();
        spoil(message);
        EXPECT_THROW(from_message(message), MessageError);
    };
    const float none = std::numeric_limits<float>::quiet_NaN();
    refused([](earlier_plane_map_t& m) { m.planes[1].label = 7; });
    refused([](earlier_plane_map_t& m) { m.planes[1].id = 1; });
    refused([](earlier_plane_map_t& m) { m.planes[1].normal[0] = 1; });
    refused([](earlier_plane_map_t& m) { m.planes[1].center[0] = 1e20f; });
    refused([](earlier_plane_map_t& m) { m.planes[1].inliers = 2; });
    refused([&](earlier_plane_map_t& m) { m.planes[1].d = none; });
    refused([&](earlier_plane_map_t& m) { m.up[0] = none; });
    refused([](earlier_plane_map_t& m) { m.utime = std::numeric_limits<std::int64_t>::max(); });
    refused([](earlier_plane_map_t& m) { m.lines[0].plane_b = 2; });
    refused([](earlier_plane_map_t& m) { m.lines[0].plane_b = 0; });
    refused([](earlier_plane_map_t& m) {
        m.points.resize(1);
        m.points[0].planes[0] = m.points[0].planes[1] = 0;
        m.points[0].planes[2] = -1;
    });
    refused([](earlier_plane_map_t& m) { m.inferred[0].plane = 2; });
    refused([](earlier_plane_map_t& m) { m.inferred[0].plane = -1; });
    refused([](earlier_plane_map_t& m) { m.inferred.push_back(m.inferred[0]); });
    refused([](earlier_plane_map_t& m) { m.inferred[0].unit = 0; });
    refused([&](earlier_plane_map_t& m) { m.inferred[0].unit = none; });
    refused([](earlier_plane_map_t& m) { m.inferred[0].ring_sizes[0] = 2; });
    refused([](earlier_plane_map_t& m) { m.inferred[0].ring_sizes[0] = 30000; });
    refused([](earlier_plane_map_t& m) { m.inferred[0].ring_sizes.pop_back(); });
}

}  // namespace
}  // namespace planemap::messages
