// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/paper_method.hpp"

#include <gtest/gtest.h>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

class PaperMethodTest : public ::testing::Test {
  protected:
    PaperMethodTest() {
        LocalKeyframe keyframe = first_.keyframe();
        method_.go_on_from(first_.frame, keyframe);
        keyframes_.add(std::move(keyframe));
        motion_.start(0);
    }
    static RenderedFrame wall(const Pose& room_from_camera) {
        return render_room(room_camera(), room_from_camera, true, {{{0, 0, -1}, 2}});
    }
    static std::vector<PlanarRegion> region(const RenderedFrame& images) {
        return {whole_view(room_camera(), images.depth)};
    }
    std::optional<Located> locate(const SeenFrame& seen) {
        return method_.locate(seen.frame, {motion_, keyframes_, relocaliser_});
    }

    OdometryOptions options_;
    RenderedFrame images_ = wall(Pose::Identity());
    SeenFrame first_{images_, 0, region(images_)};
    CameraMotion motion_{options_};
    LocalKeyframes keyframes_{3};
    Relocaliser relocaliser_{options_};
    PaperMethod method_{options_};
};

TEST_F(PaperMethodTest, PosesAreChainedFromFrameToFrame) {
    for (int i = 1; i < 5; ++i) {
        Pose room_from_camera = Pose::Identity();
        room_from_camera.translation().x() = 0.02 * i;
        const RenderedFrame images = wall(room_from_camera);
        const SeenFrame seen(images, i * kPeriod, region(images));
        auto located = locate(seen);
        ASSERT_TRUE(located) << i;
        EXPECT_FALSE(located->filtered);
        motion_.follow(i * kPeriod, *located);
        EXPECT_LT(pose_error(motion_.odom_from_camera(), room_from_camera), 0.03) << i;
        EXPECT_FALSE(method_.wants_keyframe(seen.frame, *located, keyframes_.current()));
    }
}

TEST_F(PaperMethodTest, FeaturesOffPlanesDoNotCount) {
    const SeenFrame seen(images_, kPeriod);
    EXPECT_FALSE(locate(seen)) << "no regions";
}

TEST_F(PaperMethodTest, ALostFrameIsNotGoneOnFrom) {
    method_.lose();
    const SeenFrame seen(images_, kPeriod, region(images_));
    EXPECT_FALSE(locate(seen));
}

TEST_F(PaperMethodTest, WithoutColourThereIsNoPose) {
    SeenFrame seen(images_, kPeriod, region(images_));
    seen.forget_color();
    EXPECT_FALSE(locate(seen));
    LocalKeyframe keyframe = seen.keyframe();
    method_.go_on_from(seen.frame, keyframe);
    EXPECT_TRUE(locate(first_)) << "what was seen before is still known";
}

}  // namespace
}  // namespace planemap::odometry
