// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_planes.hpp"

#include <gtest/gtest.h>

#include "map/map.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::map {
namespace {

TEST(RegionPlanes, ComeBackAsTheyWereAndDamageIsLeftOut) {
    const std::map<int, std::vector<int>> planes = {{0, {5, -1, 7}}, {3, {}}, {2000000000, {1}}};
    const std::vector<std::uint8_t> bytes = encode_region_planes(planes);
    EXPECT_EQ(decode_region_planes(bytes), planes);
    EXPECT_TRUE(decode_region_planes({}).empty());
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_LE(decode_region_planes(std::span(bytes).first(size)).size(), 3u);
    EXPECT_TRUE(decode_region_planes(std::vector<std::uint8_t>(64, 0xff)).empty()) << "a negative count";
    EXPECT_TRUE(decode_region_planes(std::vector<std::uint8_t>(64, 0x7f)).empty()) << "a huge one";
}

/// Two keyframes that see a wall each, which get their ids in the order in which they come.
TEST(RegionPlanes, GiveThePlanesOfAnotherMapperTheirIds) {
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
    other.restore_ids(one.planes_of_regions());
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

}  // namespace
}  // namespace planemap::map
