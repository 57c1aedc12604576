// SPDX-License-Identifier: BSD-3-Clause
#include "messages/keyframe_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap::messages {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

KeyframeTrajectory naming(std::initializer_list<int> ids) {
    KeyframeTrajectory trajectory;
    for (const int id : ids) trajectory.keyframes.push_back({id, 1000 * id, Pose::Identity()});
    return trajectory;
}

class Watch : public testing::Test {
  protected:
    void named(std::initializer_list<int> ids, double seconds) {
        watch_.named(naming(ids), at(seconds));
        watch_.tell(at(seconds));
    }
    static std::int64_t at(double seconds) { return static_cast<std::int64_t>(1e6 * seconds); }

    ModuleStatus status_{"map"};
    KeyframeWatch watch_{status_, "the map is incomplete"};
};

TEST_F(Watch, SaysWhatTheTrajectoryNamesAndNeverCame) {
    watch_.came(3, 2, 3000);
    named({0, 1, 2, 3}, 10);
    EXPECT_EQ(watch_.missing(), 3u);
    EXPECT_THAT(status_.remarks(), IsEmpty()) << "they may be on their way";
    watch_.tell(at(11.1));
    EXPECT_THAT(status_.remarks(),
                ElementsAre("3 keyframes of the trajectory were never received: the map is incomplete"));
    watch_.came(4, 3, 4000);
    named({0, 2, 3, 4}, 12);  // 1 was replaced
    EXPECT_THAT(status_.remarks(), ElementsAre(HasSubstr("2 keyframes of the trajectory")));
    watch_.came(0, -1, 0);
    watch_.came(2, 1, 0);
    watch_.tell(at(13));
    EXPECT_THAT(status_.remarks(), IsEmpty()) << "a log was played again";
}

TEST_F(Watch, SaysNothingWhereKeyframesComeAfterTheTrajectory) {
    for (int id = 0; id < 50; ++id) {
        named({id}, id);
        watch_.came(id, id - 1, 1000 * id);
        watch_.tell(at(id + 0.5));
        EXPECT_EQ(watch_.missing(), 0u);
    }
    EXPECT_THAT(status_.remarks(), IsEmpty());
}

TEST_F(Watch, KeyframesThatNobodyNamesDoNotPileUp) {
    for (int id = 0; id < 100000; ++id) watch_.came(id, id - 1, 1000 * id);
    named({0, 1, 99999}, 1);
    EXPECT_LE(watch_.missing(), 1u);
}

TEST_F(Watch, SaysThatAPartBegins) {
    watch_.came(0, -1, 1000000);
    watch_.came(1, 0, 2000000);
    EXPECT_THAT(status_.remarks(), IsEmpty());
    watch_.came(2, -1, 7500000);
    EXPECT_THAT(status_.remarks(),
                ElementsAre(HasSubstr("keyframe 2, at 7.500 s, does not hang on those before")));
    watch_.came(3, 2, 8000000);
    EXPECT_EQ(status_.remarks().size(), 1u) << "it stays true";
}

}  // namespace
}  // namespace planemap::messages
