// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>

#include "room.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

/// A gentle hand-like path.
Pose room_from_camera_at(int frame) {
    const double t = frame / 30.0;
    Twist twist;
    twist << 0.15 * std::sin(1.3 * t), 0.08 * std::sin(2.1 * t), 0.1 * (1 - std::cos(t)),
        0.05 * std::sin(1.7 * t), 0.12 * std::sin(1.1 * t), 0.06 * std::sin(0.9 * t);
    return pose_from_twist(twist);
}

/// A wide move to the right.
Pose sideways(int frame) {
    Pose room_from_camera = Pose::Identity();
    room_from_camera.translation().x() = 0.02 * frame;
    return room_from_camera;
}

/// Keyframes that a result gives.
int keyframes_of(const OdometryResult& result) {
    return (result.described ? 1 : 0) + (result.keyframe ? 1 : 0);
}

class Room : public ::testing::Test {
  protected:
    /// With a sensor's noise: two images of a still view differ.
    OdometryResult feed(RenderedFrame frame, std::int64_t utime, bool is_lit = true) {
        std::mt19937 random(static_cast<unsigned>(utime));
        for (std::uint8_t& luma : frame.gray.pixels)
            luma = static_cast<std::uint8_t>(luma ^ (is_lit && luma > 1 ? random() & 1 : 0));
        for (std::uint16_t& raw : frame.depth.pixels)
            raw = static_cast<std::uint16_t>(raw ^ (is_valid_depth(raw) ? random() & 1 : 0));
        return feed_as_it_is(frame, utime);
    }
    OdometryResult feed_as_it_is(const RenderedFrame& frame, std::int64_t utime) {
        return odometry_.process({utime, utime, &frame.gray, &frame.depth, &camera_, {}});
    }
    OdometryResult feed_depth(const RenderedFrame& frame, std::int64_t utime) {
        return odometry_.process({utime, 0, nullptr, &frame.depth, &camera_, {}});
    }
    RenderedFrame view(int frame) const { return render_room(camera_, room_from_camera_at(frame)); }

    CameraInfo camera_ = room_camera();
    Odometry odometry_{OdometryOptions{}};
};

void expect_near(const Pose& a, const Pose& b, double metres, double radians) {
    EXPECT_LT((a.translation() - b.translation()).norm(), metres);
    EXPECT_LT(rotation_angle(a.inverse() * b), radians);
}

TEST_F(Room, KeyframesSayHowTheirSensorMeasures) {
    camera_.noise = {0.002, 0.003, 0.5};
    camera_.depth_min_m = 0.25;
    camera_.depth_max_m = 7;
    const OdometryResult result = feed(view(0), 1000);
    ASSERT_TRUE(result.keyframe);
    EXPECT_EQ(result.keyframe->noise, camera_.noise);
    EXPECT_EQ(result.keyframe->depth_min_m, 0.25);
    EXPECT_EQ(result.keyframe->depth_max_m, 7);
}

TEST_F(Room, FirstFrameIsKeyframeZeroAtTheIdentity) {
    const OdometryResult result = feed(view(0), 1000);
    EXPECT_EQ(result.estimate.status, TrackingStatus::kTracked);
    EXPECT_TRUE(result.estimate.odom_from_camera.isApprox(Pose::Identity()));
    ASSERT_TRUE(result.keyframe);
    EXPECT_EQ(result.keyframe->id, 0);
    EXPECT_EQ(result.keyframe->previous_id, -1);
    EXPECT_GT(result.keyframe->features.size(), 50u);
}

TEST_F(Room, AStreamThatHangsLeavesTheOtherToTrack) {
    RenderedFrame held = view(0);
    for (int i = 0; i < 60; ++i) {
        RenderedFrame frame = view(i);
        const bool color_hangs = i >= 10 && i < 20, depth_hangs = i >= 30 && i < 40;
        if (color_hangs) frame.gray = held.gray;
        if (depth_hangs) frame.depth = held.depth;
        held = frame;
        const OdometryResult result = feed_as_it_is(frame, (i + 1) * kPeriod);
        ASSERT_TRUE(is_tracked(result.estimate.status)) << "frame " << i;
        EXPECT_EQ(result.news.color == News::Image::kNew, !color_hangs) << "frame " << i;
        EXPECT_EQ(result.news.depth == News::Image::kNew, !depth_hangs) << "frame " << i;
        expect_near(result.estimate.odom_from_camera, room_from_camera_at(i), 0.02, 0.01);
        EXPECT_FALSE(color_hangs && result.keyframe && !result.keyframe->features.empty()) << "frame " << i;
        EXPECT_FALSE(depth_hangs && result.keyframe) << "frame " << i;
    }
}

TEST_F(Room, WithNothingNewThePoseStaysAndGetsUncertain) {
    for (int i = 0; i < 10; ++i) feed_as_it_is(view(i), (i + 1) * kPeriod);
    const RenderedFrame held = view(10);
    const OdometryEstimate last = feed_as_it_is(held, 11 * kPeriod).estimate;
    double before = last.covariance.trace();
    for (int i = 11; i < 25; ++i) {
        const OdometryResult result = feed_as_it_is(held, (i + 1) * kPeriod);
        EXPECT_EQ(result.estimate.status, TrackingStatus::kStale);
        EXPECT_EQ(result.estimate.utime, (i + 1) * kPeriod);
        EXPECT_FALSE(result.keyframe);
        EXPECT_TRUE(result.estimate.odom_from_camera.isApprox(last.odom_from_camera));
        EXPECT_GT(result.estimate.covariance.trace(), before) << "frame " << i;
        before = result.estimate.covariance.trace();
    }
    // Honest: the true pose is within three sigma all the time.
    const Pose off = last.odom_from_camera.inverse() * room_from_camera_at(24);
    EXPECT_LT(off.translation().norm(), 3 * std::sqrt(before));
    const OdometryResult again = feed_as_it_is(view(25), 26 * kPeriod);
    EXPECT_EQ(again.estimate.status, TrackingStatus::kTracked);
    expect_near(again.estimate.odom_from_camera, room_from_camera_at(25), 0.02, 0.01);
}

TEST_F(Room, NewsThatDoNotSayWhereItIsAreWaitedForAsLongAsItCannotBeFar) {
    for (int i = 0; i < 10; ++i) feed_as_it_is(view(i), (i + 1) * kPeriod);
    RenderedFrame held = view(10);
    const OdometryEstimate last = feed_as_it_is(held, 11 * kPeriod).estimate;
    std::vector<TrackingStatus> statuses;
    for (int i = 11; i < 60; ++i) {
        held.depth = DepthImage(held.depth.width, held.depth.height);  // but for a few specks
        for (std::size_t at = 0; at < held.depth.pixels.size(); at += 4999) held.depth.pixels[at] = 1500;
        const OdometryResult result = feed_as_it_is(held, (i + 1) * kPeriod);
        statuses.push_back(result.estimate.status);
        EXPECT_FALSE(result.keyframe && i < 25);
        if (i == 11) expect_near(result.estimate.odom_from_camera, last.odom_from_camera, 1e-9, 1e-9);
    }
    EXPECT_EQ(statuses.front(), TrackingStatus::kStale);
    EXPECT_NE(std::find(statuses.begin(), statuses.end(), TrackingStatus::kLost), statuses.end());
}

TEST_F(Room, NothingButRepeatsIsOneKeyframe) {
    const RenderedFrame held = view(0);
    int keyframes = 0;
    for (int i = 0; i < 60; ++i) keyframes += keyframes_of(feed_as_it_is(held, (i + 1) * kPeriod));
    EXPECT_EQ(keyframes, 1);
}

TEST_F(Room, FollowsAKnownMotion) {
    int keyframes = 0;
    for (int i = 0; i < 90; ++i) {
        const OdometryResult result = feed(view(i), (i + 1) * kPeriod);
        ASSERT_EQ(result.estimate.status, TrackingStatus::kTracked) << "frame " << i;
        expect_near(result.estimate.odom_from_camera, room_from_camera_at(i), 0.01, 0.005);
        EXPECT_EQ(result.estimate.utime, (i + 1) * kPeriod);
        if (i > 0) {
            EXPECT_GT(result.estimate.covariance.diagonal().minCoeff(), 0);
        }
        keyframes += keyframes_of(result);
    }
    EXPECT_LT(keyframes, 30);
}

TEST_F(Room, AFastTurnWhosePoseMayBeFarOffSaysSo) {
    constexpr int kAtRest = 5, kTurning = 5;
    constexpr double kStep = 0.06;  // radians a frame: a millisecond is a tenth of a degree
    OdometryResult result;
    for (int i = 0; i < kAtRest + kTurning; ++i) {
        const double angle = kStep * std::max(0, i - kAtRest + 1);
        Pose room_from_camera = Pose::Identity();
        room_from_camera.linear() = so3_exp({0, angle, 0});
        result = feed(render_room(camera_, room_from_camera), (i + 1) * kPeriod);
        expect_near(result.estimate.odom_from_camera, room_from_camera, 0.02, 0.02);
        if (i < kAtRest) {
            EXPECT_EQ(result.estimate.status, TrackingStatus::kTracked) << "frame " << i;
        }
    }
    EXPECT_EQ(result.estimate.status, TrackingStatus::kDegenerate);
    EXPECT_GT(3 * std::sqrt(result.estimate.covariance(4, 4)), 0.0873) << "5 degrees";
}

TEST_F(Room, KeyframesAreChainedByTheirEdges) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 30; ++i) {
        const OdometryResult result = feed(render_room(camera_, sideways(i)), (i + 1) * kPeriod);
        if (result.described) keyframes.push_back(*result.described);
        if (result.keyframe) keyframes.push_back(*result.keyframe);
        ASSERT_FALSE(keyframes.empty());
        EXPECT_LE(result.estimate.keyframe_id, keyframes.back().id) << "none is named before it is known";
    }
    ASSERT_GT(keyframes.size(), 1u);
    for (std::size_t i = 1; i < keyframes.size(); ++i) {
        const Keyframe& keyframe = keyframes[i];
        EXPECT_EQ(keyframe.id, static_cast<int>(i));
        ASSERT_GE(keyframe.previous_id, 0);
        const Keyframe& previous = keyframes[static_cast<std::size_t>(keyframe.previous_id)];
        expect_near(previous.odom_from_camera * keyframe.previous_from_camera, keyframe.odom_from_camera,
                    1e-6, 1e-6);
    }
}

TEST_F(Room, TheLastFramesKeyframeIsGivenAtTheEnd) {
    EXPECT_FALSE(odometry_.finish()) << "no frame";
    int i = 0;
    std::optional<Keyframe> last;
    for (; i < 30 && !last; ++i) {
        feed(render_room(camera_, sideways(i)), (i + 1) * kPeriod);
        last = odometry_.finish();
    }
    ASSERT_TRUE(last);
    EXPECT_EQ(last->utime, i * kPeriod);
    EXPECT_GT(last->features.size(), 50u);
    EXPECT_FALSE(odometry_.finish()) << "given once";
    EXPECT_FALSE(feed(render_room(camera_, sideways(i)), (i + 1) * kPeriod).described);
}

TEST_F(Room, SameInputSamePoses) {
    Odometry other{OdometryOptions{}};
    for (int i = 0; i < 20; ++i) {
        const RenderedFrame frame = view(3 * i);
        const std::int64_t utime = (i + 1) * kPeriod;
        const Pose a = feed_as_it_is(frame, utime).estimate.odom_from_camera;
        const Pose b =
            other.process({utime, utime, &frame.gray, &frame.depth, &camera_, {}}).estimate.odom_from_camera;
        EXPECT_EQ((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), 0);
    }
}

TEST_F(Room, DepthAloneIsFollowed) {
    for (int i = 0; i < 30; ++i) {
        const OdometryResult result = feed_depth(view(i), (i + 1) * kPeriod);
        ASSERT_NE(result.estimate.status, TrackingStatus::kLost) << "frame " << i;
        expect_near(result.estimate.odom_from_camera, room_from_camera_at(i), 0.02, 0.01);
    }
}

TEST_F(Room, ColourMayGoAndComeBack) {
    for (int i = 0; i < 40; ++i) {
        const std::int64_t utime = (i + 1) * kPeriod;
        const OdometryResult result = i / 10 % 2 ? feed_depth(view(i), utime) : feed(view(i), utime);
        ASSERT_NE(result.estimate.status, TrackingStatus::kLost) << "frame " << i;
        expect_near(result.estimate.odom_from_camera, room_from_camera_at(i), 0.02, 0.01);
    }
}

TEST_F(Room, ABareWallIsDegenerateAndItsDistanceIsStillKnown) {
    const std::vector<Plane> wall{{{0, 0, -1}, 2}};
    OdometryEstimate last;
    int grown = 0;
    for (int i = 0; i < 10; ++i) {
        Pose pose = Pose::Identity();
        pose.translation().z() = 0.005 * i;
        const RenderedFrame frame = render_room(camera_, pose, false, wall);
        const OdometryResult result = feed(frame, (i + 1) * kPeriod);
        if (i == 0) continue;
        ASSERT_EQ(result.estimate.status, TrackingStatus::kDegenerate) << "frame " << i;
        EXPECT_NEAR(result.estimate.odom_from_camera.translation().z(), 0.005 * i, 0.005);
        EXPECT_GT(result.estimate.covariance(0, 0), 10 * result.estimate.covariance(2, 2));
        // A frame against the same keyframe starts from one that is no surer; a prediction errs by a
        // centimetre.
        if (result.estimate.keyframe_id == last.keyframe_id) {
            EXPECT_GT(result.estimate.covariance(0, 0), last.covariance(0, 0) + 0.9e-4);
            ++grown;
        }
        last = result.estimate;
    }
    EXPECT_GE(grown, 3);
}

/// A wall of one shade two metres ahead, as a camera sees it: with noise in its image and its depth.
RenderedFrame noisy_wall(const CameraInfo& camera, std::mt19937_64& random, double shade_sigma) {
    std::normal_distribution<double> noise(0, 1);
    RenderedFrame frame = render_room(camera, Pose::Identity(), false, {{{0, 0, -1}, 2}});
    for (auto& pixel : frame.gray.pixels)
        pixel = static_cast<std::uint8_t>(std::clamp(pixel + shade_sigma * noise(random), 0.0, 255.0));
    for (auto& pixel : frame.depth.pixels)
        pixel = static_cast<std::uint16_t>(pixel + 0.004 * camera.depth_units_per_metre * noise(random));
    return frame;
}

TEST_F(Room, StandingStillBeforeABareWallMakesNoKeyframes) {
    for (const double shade_sigma : {0.0, 2.5, 8.0}) {  // levels; at 8, noise looks like corners
        std::mt19937_64 random(1);
        Odometry odometry{OdometryOptions{}};
        int keyframes = 0;
        for (int i = 0; i < 150; ++i) {
            const RenderedFrame frame = noisy_wall(camera_, random, shade_sigma);
            const std::int64_t utime = (i + 1) * kPeriod;
            const std::vector<PlanarRegion> regions{whole_view(camera_, frame.depth)};
            const OdometryResult result =
                odometry.process({utime, utime, &frame.gray, &frame.depth, &camera_, regions});
            EXPECT_NE(result.estimate.status, TrackingStatus::kLost) << "frame " << i;
            keyframes += keyframes_of(result);
        }
        EXPECT_LE(keyframes, 2) << "noise of " << shade_sigma << " levels";
    }
}

TEST_F(Room, LightThatGoesOnMakesAKeyframe) {
    const RenderedFrame dark = render_room(camera_, Pose::Identity(), false);
    const RenderedFrame lit = render_room(camera_, Pose::Identity(), true);
    int keyframes = 0;
    for (int i = 0; i < 30; ++i) keyframes += keyframes_of(feed(dark, (i + 1) * kPeriod, false));
    EXPECT_EQ(keyframes, 1);
    for (int i = 30; i < 60; ++i) keyframes += keyframes_of(feed(lit, (i + 1) * kPeriod));
    EXPECT_EQ(keyframes, 2) << "there are corners to follow now";
    EXPECT_EQ(feed(lit, 61 * kPeriod).estimate.status, TrackingStatus::kTracked);
}

TEST_F(Room, BlackFramesAreLostAndTheViewIsFoundAgain) {
    for (int i = 0; i < 10; ++i) feed(view(i), (i + 1) * kPeriod);
    const RenderedFrame black{GrayImage(320, 240, 0), DepthImage(320, 240, 0)};
    for (int i = 10; i < 15; ++i)
        EXPECT_EQ(feed(black, (i + 1) * kPeriod).estimate.status, TrackingStatus::kLost);
    for (int i = 15; i < 20; ++i) {
        const OdometryResult result = feed(view(i), (i + 1) * kPeriod);
        ASSERT_EQ(result.estimate.status, TrackingStatus::kTracked);
        expect_near(result.estimate.odom_from_camera, room_from_camera_at(i), 0.02, 0.01);
    }
}

TEST_F(Room, WhereNothingCanBeginTheLastPoseGetsNoYounger) {
    const std::vector<Plane> wall{{{0, 0, -1}, 2}};
    const RenderedFrame bare = render_room(camera_, Pose::Identity(), false, wall);
    for (int i = 0; i < 10; ++i) feed(bare, (i + 1) * kPeriod);
    const RenderedFrame black{GrayImage(320, 240, 0), DepthImage(320, 240, 0)};
    for (int i = 10; i < 27; ++i)  // longer than it waits before it begins anew
        EXPECT_EQ(feed(black, (i + 1) * kPeriod).estimate.status, TrackingStatus::kLost);
    // Half a second later a bare wall says nothing of how far the camera went along it.
    const OdometryResult result = feed(bare, 28 * kPeriod);
    ASSERT_TRUE(result.keyframe);
    EXPECT_EQ(result.keyframe->previous_id, -1);
}

TEST_F(Room, NothingToSeeIsNoKeyframe) {
    const RenderedFrame black{GrayImage(320, 240, 0), DepthImage(320, 240, 0)};
    for (int i = 0; i < 40; ++i) {
        const OdometryResult result = feed(black, (i + 1) * kPeriod);
        EXPECT_EQ(result.estimate.status, TrackingStatus::kLost);
        EXPECT_FALSE(result.keyframe);
    }
    EXPECT_EQ(feed(view(0), 50 * kPeriod).estimate.status, TrackingStatus::kTracked);
}

TEST_F(Room, AfterALongLossTheMapGoesOnWithoutAnEdge) {
    feed(view(0), kPeriod);
    Pose elsewhere = Pose::Identity();
    elsewhere.linear() = so3_exp({0, 3.0, 0});
    std::vector<Plane> other_side = room_planes();
    other_side.push_back({{0, 0, 1}, 1.0});
    std::optional<Keyframe> keyframe;
    for (int i = 1; i < 30 && !keyframe; ++i)
        keyframe = feed(render_room(camera_, elsewhere, true, other_side), (i + 1) * kPeriod).keyframe;
    ASSERT_TRUE(keyframe);
    EXPECT_EQ(keyframe->id, 1);
    EXPECT_EQ(keyframe->previous_id, -1);
}

TEST_F(Room, TimeThatGoesBackStartsANewKeyframe) {
    for (int i = 0; i < 5; ++i) feed(view(i), (i + 100) * kPeriod);
    const OdometryResult result = feed(view(0), kPeriod);
    EXPECT_EQ(result.estimate.status, TrackingStatus::kTracked);
    ASSERT_TRUE(result.keyframe);
    EXPECT_EQ(result.keyframe->previous_id, -1);
    EXPECT_EQ(feed(view(1), 2 * kPeriod).estimate.status, TrackingStatus::kTracked);
}

TEST_F(Room, AnotherCameraStartsANewKeyframe) {
    feed(view(0), kPeriod);
    camera_.color.fx = camera_.color.fy = camera_.depth.fx = camera_.depth.fy = 240;
    const OdometryResult result = feed(view(1), 2 * kPeriod);
    ASSERT_TRUE(result.keyframe);
    EXPECT_EQ(result.keyframe->previous_id, -1);
}

TEST_F(Room, RegionsRegulariseAndBrokenOnesAreIgnored) {
    const RenderedFrame frame = view(0);
    PlanarRegion wall;
    wall.plane = {{0, 0, -1}, 3};
    for (const double x : {-1.5, 1.5})
        for (const double y : {-1.0, 1.0}) wall.moments.add({x, y, 3});
    wall.box.frame_from_box.linear() = plane_axes(wall.plane.normal, {1, 0, 0});
    wall.box.frame_from_box.translation() = Eigen::Vector3d(0, 0, 3);
    wall.box.half_extents = {1.5, 1, 0};
    PlanarRegion broken = wall;
    broken.plane.d = std::numeric_limits<double>::quiet_NaN();
    const std::vector<PlanarRegion> regions{broken, wall};
    const OdometryResult result =
        odometry_.process({kPeriod, kPeriod, &frame.gray, &frame.depth, &camera_, regions});
    ASSERT_TRUE(result.keyframe);
    ASSERT_EQ(result.keyframe->regions.size(), 1u);
    int planar = 0;
    for (const Feature& feature : result.keyframe->features) {
        if (feature.region < 0) continue;
        ++planar;
        EXPECT_EQ(feature.region, 0);
        EXPECT_NEAR(feature.point.z(), 3, 1e-5);
    }
    EXPECT_GT(planar, 20);
}

TEST_F(Room, WrongSizesAndMissingPartsAreRefused) {
    const RenderedFrame frame = view(0);
    const GrayImage small(10, 10, 0);
    const DepthImage thin(320, 239, 0);
    EXPECT_THROW(odometry_.process({1, 1, &small, &frame.depth, &camera_, {}}), std::invalid_argument);
    EXPECT_THROW(odometry_.process({1, 1, &frame.gray, &thin, &camera_, {}}), std::invalid_argument);
    EXPECT_THROW(odometry_.process({1, 1, &frame.gray, nullptr, &camera_, {}}), std::invalid_argument);
    EXPECT_THROW(odometry_.process({1, 1, &frame.gray, &frame.depth, nullptr, {}}), std::invalid_argument);
    EXPECT_EQ(feed(frame, 1).estimate.status, TrackingStatus::kTracked);
}

TEST(OdometryOptions, EveryBadFieldIsNamed) {
    OdometryOptions options;
    EXPECT_NO_THROW(options.validate());
    options.method = "magic";
    options.max_points = -1;
    options.pixel_sigma_px = std::numeric_limits<double>::quiet_NaN();
    try {
        Odometry odometry(options);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("method"), std::string::npos);
        EXPECT_NE(text.find("max_points"), std::string::npos);
        EXPECT_NE(text.find("pixel_sigma_px"), std::string::npos);
    }
}

}  // namespace
}  // namespace planemap::odometry
