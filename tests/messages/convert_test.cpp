// SPDX-License-Identifier: BSD-3-Clause
#include "messages/convert.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/stamp.hpp"
#include "messages/decode.hpp"
#include "messages/sample_messages.hpp"
#include "messages/zip.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

using test::sample_keyframe;

void expect_same(const PlanarRegion& a, const PlanarRegion& b) {
    EXPECT_EQ(a.plane.normal, b.plane.normal);
    EXPECT_EQ(a.plane.d, b.plane.d);
    EXPECT_EQ(a.moments.count, b.moments.count);
    EXPECT_EQ(a.moments.sum, b.moments.sum);
    EXPECT_EQ(a.moments.scatter, b.moments.scatter);
    EXPECT_TRUE(a.box.frame_from_box.isApprox(b.box.frame_from_box, 1e-12));
    ASSERT_EQ(a.outline.rings.size(), b.outline.rings.size());
    for (std::size_t i = 0; i < a.outline.rings.size(); ++i) {
        ASSERT_EQ(a.outline.rings[i].size(), b.outline.rings[i].size());
        for (std::size_t j = 0; j < a.outline.rings[i].size(); ++j) {
            EXPECT_LT((a.outline.rings[i][j] - b.outline.rings[i][j]).norm(), 1e-6);
        }
    }
}

TEST(Convert, CameraRoundTrip) {
    CameraInfo camera = test::sample_camera();
    camera.registered = false;
    camera.color_from_depth = make_pose({-0.025, 0, 0}, Eigen::Quaterniond::Identity());
    camera.noise.quadratic_per_m = 0.003;
    EXPECT_TRUE(from_message(to_message(camera, 1, 2)) == camera);
    camera.depth_distortion = LensDistortion{LensDistortion::Model::kBrown, {-0.2, 0.01, 0, 0.001, 0}};
    camera.color_distortion = LensDistortion{LensDistortion::Model::kFisheye, {0.01, 0, 0, 0}};
    EXPECT_TRUE(from_message(to_message(camera, 1, 2)) == camera);
    camera_info_t message = to_message(camera, 1, 2);
    message.depth_distortion.model = 9;
    EXPECT_THAT(test::error_of([&] { from_message(message); }),
                testing::HasSubstr("camera_info.depth_distortion is of model 9"));
    message = to_message(camera, 1, 2);
    message.color_distortion.coefficients.assign(3, 0.1);
    EXPECT_THAT(test::error_of([&] { from_message(message); }),
                testing::HasSubstr("color.distortion is fisheye [0.1, 0.1, 0.1], must be 4 coefficients"));
    message.color_distortion.coefficients.assign(4, std::nan(""));
    EXPECT_THROW(from_message(message), MessageError);
}

TEST(Convert, HowACameraIsMountedIsKnownOrNot) {
    CameraInfo camera = test::sample_camera();
    EXPECT_FALSE(from_message(to_message(camera, 1, 2)).body_from_camera);
    camera.body_from_camera = make_pose({0.1, 0, 0.3}, Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5));
    const CameraInfo back = from_message(to_message(camera, 1, 2));
    EXPECT_EQ(back, camera);
    ASSERT_TRUE(back.body_from_camera);
    EXPECT_TRUE(back.body_from_camera->isApprox(*camera.body_from_camera, 1e-12));
    camera_info_t message = to_message(camera, 1, 2);
    message.body_from_camera.rotation[0] = 7;
    EXPECT_THROW(from_message(message), MessageError);
    message.body_known = 0;  // then it means nothing
    EXPECT_FALSE(from_message(message).body_from_camera);
}

TEST(Convert, EachMessageSaysItsSession) {
    EXPECT_EQ(to_message(test::sample_camera(), 1, 2, 5).session, 5);
    EXPECT_EQ(to_message(FrameRegions{1, {}}, 2, 5).session, 5);
    EXPECT_EQ(to_message(OdometryEstimate(), 2, 5).session, 5);
    EXPECT_EQ(to_message(test::sample_keyframe(), 2, 5).session, 5);
    EXPECT_EQ(to_message(KeyframeTrajectory(), 2, 5).session, 5);
    EXPECT_EQ(to_message(PlaneMap(), 2, 5).session, 5);
}

TEST(Convert, ACameraWhoseResolutionsAreTooFarApartIsRefusedWithTheReason) {
    CameraInfo camera;
    camera.depth = {320, 288, 250, 250, 160, 144};
    camera.color = {3840, 2160, 1900, 1900, 1920, 1080};
    const auto message = to_message(camera, 1, 2);
    try {
        from_message(message);
        ADD_FAILURE() << "taken";
    } catch (const MessageError& error) {
        EXPECT_NE(std::string(error.what()).find("depth.fx / color.fx is 0.131579 (250 / 1900 pixels)"),
                  std::string::npos)
            << error.what();
    }
}

TEST(Convert, BadCameraNamesItsFields) {
    camera_info_t message = to_message(test::sample_camera(), 1, 2);
    message.depth.fx = 0;
    message.color.width = -4;
    message.depth_units_per_metre = std::numeric_limits<double>::quiet_NaN();
    try {
        from_message(message);
        FAIL() << "accepted";
    } catch (const MessageError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("depth.fx"), std::string::npos) << text;
        EXPECT_NE(text.find("color.width"), std::string::npos) << text;
        EXPECT_NE(text.find("depth_units_per_metre"), std::string::npos) << text;
    }
}

TEST(Convert, KeyframeRoundTrip) {
    const Keyframe keyframe = sample_keyframe();
    const Keyframe back = from_message(to_message(keyframe, 1));
    EXPECT_EQ(back.id, keyframe.id);
    EXPECT_EQ(back.previous_id, keyframe.previous_id);
    EXPECT_EQ(back.pose_utime, keyframe.pose_utime);
    EXPECT_TRUE(back.odom_from_camera.isApprox(keyframe.odom_from_camera, 1e-12));
    EXPECT_EQ(back.covariance, keyframe.covariance);
    EXPECT_EQ(to_message(keyframe, 1).session, 0);
    EXPECT_EQ(to_message(keyframe, 1, 9).session, 9);
    EXPECT_EQ(back.noise, keyframe.noise);
    EXPECT_EQ(back.depth_min_m, keyframe.depth_min_m);
    EXPECT_EQ(back.depth_max_m, keyframe.depth_max_m);
    ASSERT_EQ(back.features.size(), keyframe.features.size());
    for (std::size_t i = 0; i < back.features.size(); ++i) {
        EXPECT_EQ(back.features[i].pixel, keyframe.features[i].pixel);
        EXPECT_EQ(back.features[i].point, keyframe.features[i].point);
        EXPECT_EQ(back.features[i].region, keyframe.features[i].region);
        EXPECT_EQ(back.features[i].descriptor, keyframe.features[i].descriptor);
    }
    ASSERT_EQ(back.regions.size(), 2u);
    expect_same(back.regions[1], keyframe.regions[1]);
}

TEST(Convert, InconsistentMessagesAreErrors) {
    const auto refused = [](auto spoil) {
        keyframe_t message = to_message(sample_keyframe(), 1);
        spoil(message);
        EXPECT_THROW(from_message(message), MessageError);
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    refused([](keyframe_t& m) { m.id = -1; });
    refused([](keyframe_t& m) { m.previous_id = m.id; });
    refused([](keyframe_t& m) { m.regions_of[0] = 2; });
    refused([](keyframe_t& m) { m.descriptors.pop_back(); });
    refused([](keyframe_t& m) { m.odom_from_camera.rotation[0] = 7; });
    refused([](keyframe_t& m) { m.odom_from_camera.translation[1] = kNan; });
    refused([](keyframe_t& m) { m.covariance[7] = kNan; });
    refused([](keyframe_t& m) { m.points[0][2] = std::numeric_limits<float>::infinity(); });
    refused([](keyframe_t& m) { m.regions[0].normal[0] = 2; });
    refused([](keyframe_t& m) { m.regions[0].count = kNan; });
    refused([](keyframe_t& m) { m.regions[0].ring_sizes[0] = 99; });
    refused([](keyframe_t& m) { m.regions[0].ring_sizes[0] = 2; });
    refused([](keyframe_t& m) {  // consistent, but more than a kept outline's 16 bits can say
        m.regions[0].ring_sizes = {32768};
        m.regions[0].vertices.resize(32768);
        m.regions[0].n_rings = 1;
        m.regions[0].n_vertices = 32768;
    });
    refused([](keyframe_t& m) { m.regions[0].vertices[0][0] = std::nanf(""); });
    refused([](keyframe_t& m) { m.regions[0].half_extents[0] = -1; });
    refused([](keyframe_t& m) { m.noise_base_m = -0.001; });
    refused([](keyframe_t& m) { m.noise_base_m = kNan; });
    refused([](keyframe_t& m) { m.noise_quadratic_per_m = std::numeric_limits<double>::infinity(); });
    refused([](keyframe_t& m) { m.noise_offset_m = 1e9; });
    refused([](keyframe_t& m) { m.depth_max_m = m.depth_min_m; });
}

/// Whether a message with each of its stamps at both ends of the range is refused by the stamp's name.
template <typename Message>
void expect_bounded(const Message& good, std::int64_t Message::*stamp, const std::string& name) {
    EXPECT_NO_THROW(from_message(good)) << name;
    for (const std::int64_t utime : {INT64_MIN, INT64_MAX, kFarthestUtime + 1, -kFarthestUtime - 1}) {
        Message bad = good;
        bad.*stamp = utime;
        try {
            from_message(bad);
            ADD_FAILURE() << name << " " << utime;
        } catch (const MessageError& error) {
            EXPECT_EQ(std::string(error.what()).find(name + " is " + std::to_string(utime) + " us"), 0u)
                << error.what();
        }
    }
    Message far = good;
    far.*stamp = -kFarthestUtime;
    EXPECT_NO_THROW(from_message(far)) << name;
}

TEST(Convert, StampsOfAllMessagesAreBounded) {
    expect_bounded(to_message(test::sample_camera(), 1, 2), &camera_info_t::utime, "camera_info.utime");
    expect_bounded(to_message(FrameRegions{1, {}}, 2), &planar_regions_t::utime, "planar_regions.utime");
    expect_bounded(to_message(OdometryEstimate{}, 2), &odometry_t::utime, "odometry.utime");
    expect_bounded(to_message(OdometryEstimate{}, 2), &odometry_t::pose_utime, "odometry.pose_utime");
    expect_bounded(to_message(sample_keyframe(), 2), &keyframe_t::utime, "keyframe.utime");
    expect_bounded(to_message(sample_keyframe(), 2), &keyframe_t::pose_utime, "keyframe.pose_utime");
    expect_bounded(to_message(KeyframeTrajectory{}, 2), &trajectory_t::utime, "trajectory.utime");
    expect_bounded(to_message(PlaneMap{}, 2), &plane_map_t::utime, "plane_map.utime");
    KeyframeTrajectory trajectory;
    trajectory.keyframes.push_back({1, INT64_MIN, Pose::Identity()});
    EXPECT_THROW(from_message(to_message(trajectory, 2)), MessageError);
}

TEST(Convert, TrajectoryRoundTripAndOrder) {
    KeyframeTrajectory trajectory;
    trajectory.revision = 4;
    trajectory.loop_closures = 2;
    trajectory.keyframes = {{0, 10, Pose::Identity()},
                            {5, 20, make_pose({1, 0, 0}, Eigen::Quaterniond(1, 1, 0, 0)), 4}};
    const KeyframeTrajectory back = from_message(to_message(trajectory, 1));
    ASSERT_EQ(back.keyframes.size(), 2u);
    EXPECT_EQ(back.keyframes[1].id, 5);
    EXPECT_TRUE(
        back.keyframes[1].world_from_camera.isApprox(trajectory.keyframes[1].world_from_camera, 1e-12));
    EXPECT_EQ(back.keyframes[0].component, 0);
    EXPECT_EQ(back.keyframes[1].component, 4);
    trajectory_t odd = to_message(trajectory, 1);
    odd.n_components = 1;
    EXPECT_THROW(from_message(odd), MessageError);
    trajectory.keyframes[1].component = 6;
    EXPECT_THROW(from_message(to_message(trajectory, 1)), MessageError);
    trajectory.keyframes[1].component = 4;
    std::swap(trajectory.keyframes[0], trajectory.keyframes[1]);
    EXPECT_THROW(from_message(to_message(trajectory, 1)), MessageError);
}

TEST(Convert, AccelerationComesBackAsItWas) {
    const Acceleration reading{7, {0.1, -9.7, 1.2}};
    const Acceleration back = from_message(to_message(reading));
    EXPECT_EQ(back.utime, 7);
    EXPECT_EQ(back.acceleration_camera, reading.acceleration_camera);
    for (const double bad : {std::nan(""), 1e9}) {
        acceleration_t message = to_message(reading);
        message.acceleration[1] = bad;
        EXPECT_THROW(from_message(message), MessageError);
    }
}

TEST(Convert, SurfacesThereAndBack) {
    const Surfaces surfaces = test::sample_surfaces();
    const Surfaces back = from_message(to_message(surfaces, 1));
    EXPECT_EQ(back.utime, surfaces.utime);
    ASSERT_EQ(back.keyframes.size(), surfaces.keyframes.size());
    for (std::size_t i = 0; i < surfaces.keyframes.size(); ++i) {
        EXPECT_EQ(back.keyframes[i].id, surfaces.keyframes[i].id);
        EXPECT_EQ(back.keyframes[i].planes, surfaces.keyframes[i].planes);
    }
}

TEST(Convert, SurfacesOfWhichTheCountsDoNotAgreeAreRefused) {
    const surfaces_t good = to_message(test::sample_surfaces(), 1);
    const auto with = [&](std::size_t keyframe, std::int16_t regions) {
        surfaces_t message = good;
        message.region_counts[keyframe] = regions;
        return message;
    };
    EXPECT_THROW(from_message(with(0, 4)), MessageError);
    EXPECT_THROW(from_message(with(0, 2)), MessageError);
    EXPECT_THROW(from_message(with(1, -1)), MessageError);
    surfaces_t message = good;
    message.ids = {0, 7, 2};
    EXPECT_THROW(from_message(message), MessageError);
    message = good;
    message.ids[0] = -1;
    EXPECT_THROW(from_message(message), MessageError);
    message = good;
    message.utime = INT64_MAX;
    EXPECT_THROW(from_message(message), MessageError);
}

TEST(Convert, SeenSpaceThereAndBack) {
    for (const SeenSpace& seen : {test::sample_seen_space(), SeenSpace()}) {
        const seen_space_t message = decode<seen_space_t>(to_bytes(to_message(seen, 4, 5, 6)));
        EXPECT_EQ(message.utime, 4);
        EXPECT_EQ(message.seq, 5);
        EXPECT_EQ(message.session, 6);
        EXPECT_EQ(from_message(message), seen);
    }
}

TEST(Convert, SeenSpaceThatDoesNotMakeSenseIsRefused) {
    const auto refused = [](const auto& spoil) {
        seen_space_t message = to_message(test::sample_seen_space(), 1, 2);
        spoil(message);
        EXPECT_THROW(from_message(message), MessageError);
    };
    refused([](seen_space_t& m) { m.voxel_m = 0.2f; });
    refused([](seen_space_t& m) { m.voxel_m = std::numeric_limits<float>::quiet_NaN(); });
    for (const std::int32_t blocks : {-1, 0, 1, 3, 1000, 1 << 18, INT32_MAX})
        refused([&](seen_space_t& m) { m.n_blocks = blocks; });
    refused([](seen_space_t& m) { m.zipped.pop_back(); });
    refused([](seen_space_t& m) { m.zipped.assign(m.zipped.size(), 0); });
    refused([](seen_space_t& m) { m.zipped.clear(); });
    refused([](seen_space_t& m) { m.zipped = zip(std::vector<std::uint8_t>(140), 1); });  // one block twice
}

TEST(Convert, LooksThereAndBack) {
    const Look look = test::sample_look();
    const Look back = from_message(decode<look_t>(to_bytes(to_message(look, 1, 5))));
    EXPECT_EQ(back.utime, look.utime);
    EXPECT_EQ(back.keyframe_id, look.keyframe_id);
    EXPECT_EQ(back.keyframe_utime, look.keyframe_utime);
    EXPECT_EQ(back.number, look.number);
    EXPECT_EQ(back.looks, look.looks);
    EXPECT_TRUE(back.keyframe_from_camera.isApprox(look.keyframe_from_camera, 1e-12));
    ASSERT_EQ(back.regions.size(), 2u);
    EXPECT_EQ(back.regions[1].plane.d, look.regions[1].plane.d);
}

TEST(Convert, LooksThatMakeNoSenseAreRefused) {
    const auto refused = [](auto change) {
        look_t message = to_message(test::sample_look(), 1);
        change(message);
        EXPECT_THROW(from_message(message), MessageError);
    };
    refused([](look_t& m) { m.utime = INT64_MAX; });
    refused([](look_t& m) { m.keyframe_utime = INT64_MIN; });
    refused([](look_t& m) { m.keyframe_id = -1; });
    refused([](look_t& m) { m.number = -1; });
    refused([](look_t& m) { m.looks = 0; });
    refused([](look_t& m) { m.keyframe_from_camera.rotation[0] = 7; });
    refused([](look_t& m) { m.regions[0].d = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace planemap::messages
