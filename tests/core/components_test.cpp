// SPDX-License-Identifier: BSD-3-Clause
#include "core/components.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap {
namespace {

using ::testing::ElementsAre;

/// Keyframes 0, 1, 2, ... of these components.
KeyframeTrajectory trajectory_of(const std::vector<int>& components) {
    KeyframeTrajectory trajectory;
    for (const int component : components) {
        const int id = static_cast<int>(trajectory.keyframes.size());
        trajectory.keyframes.push_back({id, 1000 * id, Pose::Identity(), component});
        trajectory.utime = 1000 * id;
    }
    return trajectory;
}

TEST(Components, TheLargestComesFirstOfAsManyTheOlder) {
    EXPECT_THAT(components(trajectory_of({0, 0, 2, 3, 3, 3, 2})), ElementsAre(3, 0, 2));
    EXPECT_EQ(largest_component(trajectory_of({0, 0, 2, 2})), 0);
    EXPECT_THAT(components({}), ElementsAre());
    EXPECT_EQ(largest_component({}), 0);
}

TEST(Components, OneOfThemHasItsKeyframesAlone) {
    const KeyframeTrajectory part = of_component(trajectory_of({0, 1, 1, 0, 4}), 1);
    ASSERT_EQ(part.keyframes.size(), 2u);
    EXPECT_EQ(part.keyframes[0].id, 1);
    EXPECT_EQ(part.keyframes[1].id, 2);
    EXPECT_EQ(part.utime, 2000);
    EXPECT_TRUE(of_component(trajectory_of({0}), 7).keyframes.empty());
}

TEST(Components, FilesOfTheFirstHaveTheirPlainNames) {
    EXPECT_EQ(component_file("trajectory.txt", 1), "trajectory.txt");
    EXPECT_EQ(component_file("trajectory.txt", 2), "trajectory_2.txt");
    EXPECT_EQ(component_file("plane_map.lcmlog", 12), "plane_map_12.lcmlog");
}

}  // namespace
}  // namespace planemap
