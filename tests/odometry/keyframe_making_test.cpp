// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_making.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "odometry/alignment.hpp"
#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

const OdometryOptions kOptions;

TEST(KeyframeMakingTest, PointsLieOnTheirPixelsAndTheirDepth) {
    const SeenFrame seen(Pose::Identity());
    const LocalKeyframe keyframe = seen.keyframe();
    EXPECT_GT(keyframe.points.size(), 50u);
    EXPECT_GT(keyframe.patches.cells(), 150);
    EXPECT_FALSE(keyframe.pyramid.empty());
    EXPECT_EQ(keyframe.pixels().size(), keyframe.points.size());
    for (const TrackPoint& point : keyframe.points) {
        const Eigen::Vector2d pixel(point.pixel.x, point.pixel.y);
        EXPECT_LT((seen.frame.camera->color.project(point.point) - pixel).norm(), 1e-6);
        EXPECT_GT(point.inverse_depth_sigma, 0);
        EXPECT_EQ(point.per_readout.norm(), 0) << "at rest";
    }
}

TEST(KeyframeMakingTest, PointsOfAMovingCameraAreWhereTheyWereAtTheDepthImagesTime) {
    const SeenFrame seen(Pose::Identity());
    FrameMotion motion;
    motion.velocity << 0, 0, 0, 0, 0.5, 0;  // radians a second
    motion.color_offset_s = 0.01;
    const LocalKeyframe moving = make_local_keyframe(kOptions, seen.frame, motion);
    ASSERT_GT(moving.points.size(), 50u);
    const Pose color_from_depth_time = pose_from_twist(motion.color_offset_s * motion.velocity);
    for (const TrackPoint& point : moving.points) {
        const Eigen::Vector2d pixel(point.pixel.x, point.pixel.y);
        const Eigen::Vector2d then = seen.frame.camera->color.project(color_from_depth_time * point.point);
        EXPECT_LT((then - pixel).norm(), 0.1);
    }
}

TEST(KeyframeMakingTest, ARollingShutterIsTakenOut) {
    SeenFrame seen(Pose::Identity());
    seen.frame.readout_s = 0.03;
    FrameMotion motion;
    motion.velocity << 0.5, 0, 0, 0, 0, 0;
    const LocalKeyframe keyframe = make_local_keyframe(kOptions, seen.frame, motion);
    const PinholeCamera& camera = seen.frame.camera->color;
    for (const TrackPoint& point : keyframe.points) {
        const double late = row_share(camera, static_cast<double>(point.pixel.y)) * seen.frame.readout_s;
        const Eigen::Vector3d when_seen = moved(late * motion.velocity, point.point);
        EXPECT_LT((camera.project(when_seen) - Eigen::Vector2d(point.pixel.x, point.pixel.y)).norm(), 0.05);
    }
}

TEST(KeyframeMakingTest, PointsOnARegionLieOnItsPlaneAndAreSurer) {
    const RenderedFrame images = render_room(room_camera(), Pose::Identity(), true, {{{0, 0, -1}, 2}});
    const PlanarRegion wall = whole_view(room_camera(), images.depth);
    const SeenFrame with(images, 0, {wall}), without(images);
    const LocalKeyframe on = with.keyframe(), off = without.keyframe();
    ASSERT_EQ(on.points.size(), off.points.size());
    int planar = 0;
    for (std::size_t i = 0; i < on.points.size(); ++i) {
        EXPECT_EQ(off.points[i].region, -1);
        if (on.points[i].region < 0) continue;
        ++planar;
        EXPECT_NEAR(wall.plane.signed_distance(on.points[i].point), 0, 1e-9);
        EXPECT_LT(on.points[i].inverse_depth_sigma, off.points[i].inverse_depth_sigma);
    }
    EXPECT_GT(planar, 20);
}

TEST(KeyframeMakingTest, WithoutColourThereIsDepth) {
    SeenFrame seen(Pose::Identity());
    seen.forget_color();
    const LocalKeyframe local = make_local_keyframe(kOptions, seen.frame, {});
    EXPECT_TRUE(local.points.empty());
    EXPECT_TRUE(local.pyramid.empty());
    EXPECT_GT(local.patches.cells(), 150);
    EXPECT_TRUE(make_keyframe(kOptions, seen.frame, {}).features.empty());
}

TEST(KeyframeMakingTest, NothingMakesNothing) {
    const SeenFrame black(black_frame());
    const LocalKeyframe local = black.keyframe();
    EXPECT_TRUE(local.points.empty());
    EXPECT_EQ(local.patches.cells(), 0);
    EXPECT_TRUE(make_keyframe(kOptions, black.frame, {}).features.empty());
}

TEST(KeyframeMakingTest, FeaturesAreForTheDepthImagesTime) {
    const SeenFrame seen(Pose::Identity(), 5);
    const Keyframe at_rest = make_keyframe(kOptions, seen.frame, {});
    FrameMotion motion;
    motion.velocity << 1, 0, 0, 0, 0, 0;
    motion.color_offset_s = 0.01;
    const Keyframe moving = make_keyframe(kOptions, seen.frame, motion);
    EXPECT_EQ(at_rest.utime, 5);
    EXPECT_EQ(at_rest.pose_utime, 5);
    ASSERT_EQ(at_rest.features.size(), moving.features.size());
    ASSERT_GT(at_rest.features.size(), 50u);
    for (std::size_t i = 0; i < moving.features.size(); ++i)
        EXPECT_NEAR(moving.features[i].point.x(), at_rest.features[i].point.x() - 0.01f, 1e-5f);
}

TEST(KeyframeMakingTest, AKeyframeThatIsDescribedLaterIsTheSame) {
    auto seen = std::make_unique<SeenFrame>(Pose::Identity());
    FrameMotion motion;
    motion.velocity << 0, 0, 0, 0, 0.5, 0;
    motion.color_offset_s = 0.01;
    const Keyframe at_once = make_keyframe(kOptions, seen->frame, motion);
    UndescribedKeyframe waiting(seen->frame, motion);
    EXPECT_TRUE(waiting.has_color());
    EXPECT_TRUE(waiting.keyframe.features.empty());
    waiting.keyframe.id = 7;
    seen.reset();
    const Keyframe later = waiting.described(kOptions);
    EXPECT_EQ(later.id, 7);
    EXPECT_EQ(later.utime, at_once.utime);
    ASSERT_EQ(later.features.size(), at_once.features.size());
    ASSERT_GT(later.features.size(), 50u);
    for (std::size_t i = 0; i < later.features.size(); ++i) {
        EXPECT_EQ(later.features[i].descriptor, at_once.features[i].descriptor);
        EXPECT_EQ(later.features[i].point, at_once.features[i].point);
    }
}

}  // namespace
}  // namespace planemap::odometry
