// SPDX-License-Identifier: BSD-3-Clause
#include "graph/surroundings.hpp"

#include <gtest/gtest.h>

#include "places/synthetic.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;

class SurroundingsTest : public testing::Test {
  protected:
    /// Views all round a room of these landmarks.
    std::vector<places::KeyframeView> look_around(const std::vector<test::Landmark>& room) {
        std::vector<places::KeyframeView> views;
        for (const Pose& pose : poses_) {
            Keyframe keyframe;
            keyframe.features = see(room, pose, random_);
            views.push_back(places::make_view(keyframe, 600));
        }
        return views;
    }
    std::vector<SurroundingView> placed(const std::vector<places::KeyframeView>& views, double drift_m = 0.1,
                                        const Pose& move = Pose::Identity()) const {
        std::vector<SurroundingView> placed;
        for (std::size_t i = 0; i < views.size(); ++i)
            placed.push_back({&views[i], move * poses_[i], drift_m});
        return placed;
    }
    static void give_wall(std::vector<places::KeyframeView>& views, double z) {
        Pose box = Pose::Identity();
        box.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
        box.translation().z() = z;
        for (places::KeyframeView& view : views) view.regions = {rectangle(box, 0.4 * z, 0.3 * z)};
    }

    Random random_{1};
    std::vector<Pose> poses_ = [] {
        std::vector<Pose> poses;
        for (int i = 0; i < 8; ++i) poses.push_back(looking(Eigen::Vector3d::Zero(), i * M_PI / 4));
        return poses;
    }();
    std::vector<test::Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 2000);
};

TEST_F(SurroundingsTest, TheSameRoomIsAlike) {
    const auto first = look_around(room_), second = look_around(room_);
    const Surroundings found = compare_surroundings(placed(first), placed(second), {});
    EXPECT_EQ(found.alike, 8);
    EXPECT_EQ(found.unlike, 0);
    EXPECT_TRUE(found.fit());
}

TEST_F(SurroundingsTest, DriftWithinItsBoundMakesNothingUnlike) {
    const auto first = look_around(room_), second = look_around(room_);
    const Pose drift = make_pose({0.2, 0.05, -0.2}, Eigen::Quaterniond(1, 0, 0.03, 0));
    EXPECT_EQ(compare_surroundings(placed(first, 0.4), placed(second, 0.4, drift), {}).unlike, 0);
}

TEST_F(SurroundingsTest, OtherLooksAreUnlike) {
    const auto first = look_around(room_),
               second = look_around(make_room(random_, Eigen::Vector3d::Zero(), 2.5, 2000));
    const Surroundings found = compare_surroundings(placed(first), placed(second), {});
    EXPECT_EQ(found.alike, 0);
    EXPECT_EQ(found.unlike, 8);
    EXPECT_FALSE(found.fit());
}

TEST_F(SurroundingsTest, AWallThatTheOthersSawThroughIsUnlike) {
    auto first = look_around(room_), second = look_around(room_);
    give_wall(first, 2.5);
    give_wall(second, 1.2);
    EXPECT_EQ(compare_surroundings(placed(first), placed(second), {}).unlike, 8);
    EXPECT_EQ(compare_surroundings(placed(first, 2.0), placed(second, 2.0), {}).unlike, 0)
        << "drift may have moved it so far";
}

TEST_F(SurroundingsTest, ViewsOfOtherPlacesSayNothing) {
    const auto first = look_around(room_), second = look_around(room_);
    const Pose away = make_pose({10, 0, 0}, Eigen::Quaterniond::Identity());
    const Surroundings found = compare_surroundings(placed(first), placed(second, 0.1, away), {});
    EXPECT_EQ(found.alike + found.unlike, 0);
    EXPECT_TRUE(found.fit());
    EXPECT_TRUE(compare_surroundings({}, {}, {}).fit());
    const std::vector<places::KeyframeView> blind(8);
    EXPECT_TRUE(compare_surroundings(placed(blind), placed(first), {}).fit());
}

TEST_F(SurroundingsTest, AFewThatDoNotFitCountMoreThanManyAlike) {
    EXPECT_TRUE((Surroundings{0, 1}).fit());
    EXPECT_TRUE((Surroundings{20, 3}).fit());
    EXPECT_FALSE((Surroundings{10, 3}).fit());
}

}  // namespace
}  // namespace planemap::graph
