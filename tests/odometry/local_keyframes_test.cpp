// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/local_keyframes.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

LocalKeyframe keyframe(int id) {
    LocalKeyframe local;
    local.id = id;
    return local;
}

std::vector<int> ids(const LocalKeyframes& keyframes) {
    std::vector<int> ids;
    for (const LocalKeyframe& local : keyframes.all()) ids.push_back(local.id);
    return ids;
}

TEST(LocalKeyframesTest, TheNewestIsCurrentAndTheOldestGoes) {
    LocalKeyframes keyframes(2);
    EXPECT_TRUE(keyframes.empty());
    for (int i = 0; i < 5; ++i) {
        keyframes.add(keyframe(i));
        EXPECT_EQ(keyframes.current().id, i);
    }
    EXPECT_EQ(ids(keyframes), (std::vector{2, 3, 4}));
    keyframes.clear();
    EXPECT_TRUE(keyframes.empty());
    keyframes.add(keyframe(9));
    EXPECT_EQ(keyframes.current().id, 9);
}

TEST(LocalKeyframesTest, OneIsKeptWithoutOthers) {
    LocalKeyframes keyframes(0);
    keyframes.add(keyframe(1));
    keyframes.add(keyframe(2));
    EXPECT_EQ(ids(keyframes), std::vector{2});
}

TEST(LocalKeyframesTest, AnotherCanBeMadeCurrent) {
    LocalKeyframes keyframes(3);
    for (int i = 0; i < 4; ++i) keyframes.add(keyframe(i));
    keyframes.make_current(1);
    EXPECT_EQ(keyframes.current().id, 1);
    EXPECT_EQ(ids(keyframes), (std::vector{0, 1, 2, 3}));
    keyframes.make_current(77);
    EXPECT_EQ(keyframes.current().id, 1) << "one that is not here changes nothing";
    EXPECT_EQ(keyframes.find(77), nullptr);
    EXPECT_EQ(keyframes.find(2)->id, 2);
}

TEST(LocalKeyframesTest, ARenewedOneStaysLongest) {
    LocalKeyframes keyframes(2);
    for (int i = 0; i < 3; ++i) keyframes.add(keyframe(i));
    keyframes.renew(0);
    EXPECT_EQ(keyframes.current().id, 0);
    EXPECT_EQ(ids(keyframes), (std::vector{1, 2, 0}));
    keyframes.renew(77);
    EXPECT_EQ(keyframes.current().id, 0);
    keyframes.add(keyframe(3));
    EXPECT_EQ(ids(keyframes), (std::vector{2, 0, 3}));
}

}  // namespace
}  // namespace planemap::odometry
