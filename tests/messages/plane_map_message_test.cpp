// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "messages/sample_messages.hpp"

namespace planemap::messages {
namespace {

TEST(PlaneMapMessage, ComesBack) {
    PlaneMap map = test::sample_map();
    map.up = {0, -1, 0};
    map.utime = 5;
    map.revision = 6;
    map.component = 7;
    const plane_map_t message = to_message(map, 3, 4);
    EXPECT_EQ(message.seq, 3);
    EXPECT_EQ(message.session, 4);
    EXPECT_EQ(message.unit, 0.005f);
    const PlaneMap back = from_message(message);
    EXPECT_EQ(back.utime, 5);
    EXPECT_EQ(back.revision, 6);
    EXPECT_EQ(back.component, 7);
    EXPECT_EQ(back.up, map.up);
    EXPECT_EQ(back.planes.size(), 3u);
    EXPECT_EQ(back.lines.size(), 1u);
    EXPECT_EQ(back.points.size(), 1u);
    EXPECT_EQ(back.inferred.size(), 1u);
}

TEST(PlaneMapMessage, LabelsAreTheConstants) {
    PlaneMap map = test::sample_map();
    map.planes[0].label = PlaneLabel::kVertical;
    EXPECT_EQ(from_message(to_message(map, 1)).planes[0].label, PlaneLabel::kVertical);
    EXPECT_EQ(static_cast<int>(PlaneLabel::kVertical), int{plane_map_t::LABEL_VERTICAL});
    EXPECT_EQ(static_cast<int>(PlaneLabel::kWall), int{plane_map_t::LABEL_WALL});
}

TEST(PlaneMapMessage, WhatMakesNoSenseIsRefused) {
    const auto refused = [](auto spoil) {
        plane_map_t message = to_message(test::sample_map(), 1);
        spoil(message);
        EXPECT_THROW(from_message(message), MessageError);
    };
    refused([](plane_map_t& m) { m.utime = std::numeric_limits<std::int64_t>::min(); });
    refused([](plane_map_t& m) { m.component = -1; });
    refused([](plane_map_t& m) { m.up[0] = 1, m.up[1] = 1; });
    refused([](plane_map_t& m) { m.up[0] = std::numeric_limits<float>::quiet_NaN(); });
    refused([](plane_map_t& m) { m.unit = 0; });
    refused([](plane_map_t& m) { m.packed.pop_back(); });
    refused([](plane_map_t& m) { m.packed.push_back(0); });
    refused([](plane_map_t& m) { m.packed.clear(); });
}

}  // namespace
}  // namespace planemap::messages
