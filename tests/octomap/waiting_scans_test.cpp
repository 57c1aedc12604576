// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/waiting_scans.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

class Waiting : public testing::Test {
  protected:
    WaitingScans waiting_;
    std::vector<ScanId> given_;

    static std::shared_ptr<const StoredScan> scan() {
        return std::make_shared<StoredScan>(test::room(test::small_camera()), test::small_camera());
    }
    bool add_keyframe(int id) {
        waiting_.announce(id);
        return waiting_.add_keyframe(id, scan());
    }
    bool add_look(int of) {
        Look look;
        look.keyframe_id = of;
        return waiting_.add_look(look, scan());
    }
    WaitingScans::Taker taker() {
        return [this](ScanId id, const auto&, const Pose&, const ScanAnchor&) { given_.push_back(id); };
    }
    void place(const KeyframeTrajectory& trajectory) {
        waiting_.give_keyframes(trajectory, taker());
        waiting_.give_looks(taker());
    }
};

TEST_F(Waiting, KeyframesAreGivenOnceATrajectoryNamesThem) {
    for (const int id : {2, 0, 1}) EXPECT_TRUE(add_keyframe(id));
    place(test::trajectory({Pose::Identity(), Pose::Identity()}));
    EXPECT_THAT(given_, testing::ElementsAre(ScanId(0), ScanId(1)));
    EXPECT_EQ(waiting_.keyframes(), 1u);
    EXPECT_EQ(waiting_.keyframes_among({1, 2, 3}), 1u);
    place(test::trajectory({Pose::Identity(), Pose::Identity()}));
    EXPECT_EQ(given_.size(), 2u) << "once";
}

TEST_F(Waiting, LooksComeAfterTheirKeyframeAndInTheirOrder) {
    add_keyframe(0);
    add_look(0);
    add_look(0);
    waiting_.give_looks(taker());
    EXPECT_TRUE(given_.empty()) << "keyframe 0 has no pose yet";
    place(test::trajectory({Pose::Identity()}));
    EXPECT_THAT(given_, testing::ElementsAre(ScanId(0), ScanId(0, 1), ScanId(0, 2)));
    add_keyframe(1);
    add_look(0);
    waiting_.give_looks(taker());
    EXPECT_EQ(given_.size(), 3u) << "it came after keyframe 1, which waits";
    place(test::trajectory({Pose::Identity(), Pose::Identity()}));
    EXPECT_EQ(given_.back(), ScanId(1, 1)) << "numbered anew after each keyframe";
}

TEST_F(Waiting, ALooksPoseIsThatOfItsAnchor) {
    add_keyframe(0);
    Look look;
    look.keyframe_id = 0;
    look.keyframe_from_camera = test::pose(0.5, 0);
    waiting_.add_look(look, scan());
    const Pose world_from_keyframe = test::pose(1, 0.3);
    waiting_.give_keyframes(test::trajectory({world_from_keyframe}), taker());
    std::optional<Pose> pose;
    waiting_.give_looks([&](ScanId, const auto&, const Pose& at, const ScanAnchor&) { pose = at; });
    ASSERT_TRUE(pose);
    EXPECT_TRUE(pose->isApprox(world_from_keyframe * look.keyframe_from_camera));
}

TEST_F(Waiting, OfMoreThanMayWaitTheFirstGo) {
    const int most = static_cast<int>(WaitingScans::kMost);
    for (int id = 0; id < most; ++id) EXPECT_TRUE(add_keyframe(id));
    EXPECT_FALSE(add_keyframe(most));
    EXPECT_EQ(waiting_.keyframes_among({0}), 0u);
    for (int i = 0; i < most; ++i) EXPECT_TRUE(add_look(0));
    EXPECT_FALSE(add_look(0));
}

TEST_F(Waiting, ALookWhoseKeyframesPlaceIsForgottenIsNotGiven) {
    add_keyframe(0);
    place(test::trajectory({Pose::Identity()}));
    add_look(0);
    waiting_.start_over();
    add_look(0);
    waiting_.give_looks(taker());
    EXPECT_THAT(given_, testing::ElementsAre(ScanId(0)));
}

}  // namespace
}  // namespace planemap::octomap
