// SPDX-License-Identifier: BSD-3-Clause
// What holds for every method.
#include "odometry/method.hpp"

#include <gtest/gtest.h>

#include "odometry/paper_method.hpp"
#include "odometry/planar_method.hpp"
#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

/// A textured wall 2 m ahead, as one region.
std::unique_ptr<SeenFrame> wall_from(const Pose& room_from_camera, std::int64_t utime) {
    RenderedFrame images = render_room(room_camera(), room_from_camera, true, {{{0, 0, -1}, 2}});
    const PlanarRegion region = whole_view(room_camera(), images.depth);
    return std::make_unique<SeenFrame>(std::move(images), utime, std::vector{region});
}

class MethodTest : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        options_.method = GetParam();
        first_ = wall_from(Pose::Identity(), 0);
        method_ = make_method(options_);
        LocalKeyframe keyframe = first_->keyframe();
        method_->begin(first_->frame);
        method_->go_on_from(first_->frame, keyframe);
        keyframes_.add(std::move(keyframe));
        motion_.start(0);
    }
    std::optional<Located> locate(const SeenFrame& seen) {
        return method_->locate(seen.frame, {motion_, keyframes_, relocaliser_});
    }

    OdometryOptions options_;
    std::unique_ptr<SeenFrame> first_;
    CameraMotion motion_{options_};
    LocalKeyframes keyframes_{3};
    Relocaliser relocaliser_{options_};
    std::unique_ptr<Method> method_;
};

TEST_P(MethodTest, LocatesAFrameAfterAMotion) {
    for (int seed = 0; seed < 3; ++seed) {
        SetUp();
        const Pose room_from_camera = small_motion(seed);
        const auto seen = wall_from(room_from_camera, kPeriod);
        const auto located = locate(*seen);
        ASSERT_TRUE(located);
        EXPECT_EQ(located->keyframe_id, 0);
        EXPECT_FALSE(located->relocalised);
        EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 0.02);
        EXPECT_GT(located->covariance().diagonal().minCoeff(), 0);
    }
}

TEST_P(MethodTest, NothingIsLocatedInNothing) {
    const SeenFrame black(black_frame(), kPeriod);
    EXPECT_FALSE(locate(black));
}

TEST_P(MethodTest, TheSameFramesGiveTheSamePose) {
    const auto seen = wall_from(small_motion(1), kPeriod);
    const auto once = locate(*seen);
    SetUp();
    const auto again = locate(*seen);
    ASSERT_TRUE(once && again);
    EXPECT_EQ(once->odom_from_camera().matrix(), again->odom_from_camera().matrix());
}

INSTANTIATE_TEST_SUITE_P(All, MethodTest, ::testing::Values("planar", "paper"));

}  // namespace
}  // namespace planemap::odometry
