// SPDX-License-Identifier: BSD-3-Clause
#include "graph/admission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace planemap::graph {
namespace {

using testing::HasSubstr;

constexpr int kMost = std::numeric_limits<int>::max();

std::string refusal(const Keyframe& keyframe, std::optional<int> last_id) {
    try {
        check(keyframe, last_id);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

Keyframe sound(int id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.features.emplace_back();
    return keyframe;
}

TEST(AdmissionTest, TheNextIdFollowsAndSoDoesOneThatIsALittleLater) {
    EXPECT_TRUE(follows(1, 0));
    EXPECT_TRUE(follows(10000, 0));
    EXPECT_FALSE(follows(10001, 0));
    EXPECT_FALSE(follows(0, 0));
    EXPECT_FALSE(follows(-1, 0));
    EXPECT_TRUE(follows(kMost, kMost - 1));
    EXPECT_FALSE(follows(0, kMost));
}

TEST(AdmissionTest, ASoundKeyframeIsTakenInAndTheFirstMayHaveAnyId) {
    EXPECT_EQ(refusal(sound(3), 2), "");
    EXPECT_EQ(refusal(sound(kMost), std::nullopt), "");
    EXPECT_THAT(refusal(sound(-1), std::nullopt), HasSubstr("id is -1"));
}

TEST(AdmissionTest, EveryBadFieldIsNamedAtOnce) {
    Keyframe keyframe = sound(7);
    keyframe.previous_id = 7;
    keyframe.odom_from_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
    const std::string text = refusal(keyframe, 7);
    for (const char* field : {"id is 7", "previous_id", "odom_from_camera"})
        EXPECT_THAT(text, HasSubstr(field));
}

TEST(AdmissionTest, TheFirstBadFeatureAndRegionIsNamedByItsNumber) {
    Keyframe keyframe = sound(1);
    keyframe.features.emplace_back().point.x() = std::numeric_limits<float>::infinity();
    EXPECT_THAT(refusal(keyframe, 0), HasSubstr("features[1].point"));
    keyframe = sound(1);
    keyframe.regions.emplace_back();
    EXPECT_THAT(refusal(keyframe, 0), HasSubstr("regions[0]"));
}

TEST(AdmissionTest, AStepFromNowhereIsNotAsked) {
    Keyframe keyframe = sound(1);
    keyframe.previous_id = -1;
    keyframe.previous_from_camera.linear().setZero();
    EXPECT_EQ(refusal(keyframe, 0), "");
    keyframe.previous_id = 0;
    EXPECT_THAT(refusal(keyframe, 0), HasSubstr("previous_from_camera"));
}

}  // namespace
}  // namespace planemap::graph
