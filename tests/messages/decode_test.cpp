// SPDX-License-Identifier: BSD-3-Clause
#include "messages/decode.hpp"

#include <gtest/gtest.h>

#include <kinect/frame_msg_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <random>

#include "messages/frame_decoder.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::messages {
namespace {

using test::encoded;
using test::sample_map;
using test::sample_trajectory;

bot_core::images_t sample_images() {
    bot_core::images_t images;
    images.utime = 5;
    images.image_types = {bot_core::images_t::LEFT, bot_core::images_t::DEPTH_MM};
    images.images = {color_image_message(RgbImage(8, 6), 4, ColorEncoding::kRaw, 90),
                     depth_image_message(DepthImage(8, 6, 1000), 5, DepthEncoding::kRaw)};
    set_seq(images.images.back(), 9);
    images.n_images = 2;
    return images;
}

kinect::frame_msg_t sample_kinect() {
    kinect::frame_msg_t frame{};
    frame.image.image_data_nbytes = 4;
    frame.image.image_data = {1, 2, 3, 4};
    frame.depth.depth_data_nbytes = 2;
    frame.depth.depth_data = {5, 6};
    return frame;
}

module_status_t sample_status() {
    module_status_t status{};
    status.module = "x";
    status.text = "y";
    return status;
}

/// Round trip, then every truncation, trailing bytes, every single corrupt byte set to hostile values, and
/// random bytes: a message or MessageError, nothing else.
template <typename T>
void torment(const T& message) {
    const std::vector<std::uint8_t> good = encoded(message);
    ASSERT_EQ(encoded(decode<T>(good)), good) << T::getTypeName();

    for (std::size_t length = 0; length < good.size(); ++length) {
        EXPECT_THROW(decode<T>(std::span(good).first(length)), MessageError)
            << T::getTypeName() << " cut to " << length;
    }
    std::vector<std::uint8_t> longer = good;
    longer.push_back(0);
    EXPECT_THROW(decode<T>(longer), MessageError) << T::getTypeName();

    for (std::size_t i = 8; i < good.size(); ++i) {
        for (const int hostile : {0x00, 0x7f, 0x80, 0xff}) {
            std::vector<std::uint8_t> bad = good;
            bad[i] = static_cast<std::uint8_t>(hostile);
            try {
                decode<T>(bad);
            } catch (const MessageError&) {
            }
        }
    }
    std::mt19937_64 random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint8_t> noise(good.begin(), good.begin() + 8);
        noise.resize(8 + random() % 300);
        for (std::size_t i = 8; i < noise.size(); ++i) noise[i] = static_cast<std::uint8_t>(random());
        try {
            decode<T>(noise);
        } catch (const MessageError&) {
        }
    }
}

TEST(Decode, SurvivesHostileBytes) {
    torment(sample_images());
    torment(to_message(test::sample_camera(), 1, 2));
    CameraInfo bent = test::sample_camera();
    bent.depth_distortion = LensDistortion{LensDistortion::Model::kBrown, {0.1, 0, 0, 0}};
    torment(to_message(bent, 1, 2));
    torment(to_message(Acceleration{1, {0, -9.8, 0}}));
    torment(to_message(FrameRegions{7, {test::sample_region()}}, 3));
    torment(to_message(OdometryEstimate(), 4));
    torment(to_message(test::sample_keyframe(), 5));
    torment(to_message(sample_trajectory(), 6));
    torment(to_message(test::sample_surfaces(), 6));
    torment(to_message(sample_map(), 7));
    torment(test::sample_earlier_map());
    torment(to_message(test::sample_seen_space(), 7, 1));
    torment(sample_kinect());
    torment(sample_status());
    torment(map_size_t{});
    torment(bot_core::pose_t{});
}

TEST(Decode, AnotherTypesFingerprintIsAnError) {
    const auto bytes = encoded(to_message(OdometryEstimate(), 1));
    EXPECT_NO_THROW(decode<odometry_t>(bytes));
    EXPECT_THROW(decode<keyframe_t>(bytes), MessageError);
}

/// A message of a type that grew is bounded like any other.
TEST(Decode, AnEarlierTypesMessageIsTakenAndADamagedOneIsRefused) {
    earlier_plane_map_t map = test::sample_earlier_map();
    map.inferred.clear();
    map.n_inferred = 0;
    const std::vector<std::uint8_t> last = encoded(map);
    ASSERT_EQ(fingerprints<earlier_plane_map_t>().size(), 3u);
    for (const auto& [number, missing] :
         {std::pair(1, 8), std::pair(2, 16)}) {  // n_inferred, component; session, too
        std::vector<std::uint8_t> earlier = last;
        earlier.resize(earlier.size() - static_cast<std::size_t>(missing));
        const std::uint64_t fingerprint =
            fingerprints<earlier_plane_map_t>().at(static_cast<std::size_t>(number));
        for (std::size_t i = 0; i < 8; ++i)
            earlier[i] = static_cast<std::uint8_t>(fingerprint >> (56 - 8 * i));
        EXPECT_EQ(encoded(decode<earlier_plane_map_t>(earlier)), last);
        EXPECT_TRUE(is_a<earlier_plane_map_t>(earlier));
        EXPECT_EQ(plane_map_from(earlier).planes.size(), 2u);
        EXPECT_FALSE(is_a<camera_info_t>(earlier));
        for (std::size_t length = 0; length < earlier.size(); ++length)
            EXPECT_THROW(decode<earlier_plane_map_t>(std::span(earlier).first(length)), MessageError)
                << length;
    }
}

TEST(Decode, BeforeThereWereComponentsAllHungTogether) {
    KeyframeTrajectory trajectory = sample_trajectory();
    std::vector<std::uint8_t> bytes = encoded(to_message(trajectory, 1));
    bytes.resize(bytes.size() - 4 - 4 * trajectory.keyframes.size());
    ASSERT_EQ(fingerprints<trajectory_t>().size(), 2u);
    for (std::size_t i = 0; i < 8; ++i)
        bytes[i] = static_cast<std::uint8_t>(fingerprints<trajectory_t>()[1] >> (56 - 8 * i));
    const KeyframeTrajectory back = from_message(decode<trajectory_t>(bytes));
    ASSERT_EQ(back.keyframes.size(), trajectory.keyframes.size());
    for (const KeyframePose& keyframe : back.keyframes)
        EXPECT_EQ(keyframe.component, trajectory.keyframes.front().id);

    bytes = encoded(to_message(test::sample_keyframe(), 1));
    bytes.resize(bytes.size() - 4);
    ASSERT_EQ(fingerprints<keyframe_t>().size(), 2u);
    for (std::size_t i = 0; i < 8; ++i)
        bytes[i] = static_cast<std::uint8_t>(fingerprints<keyframe_t>()[1] >> (56 - 8 * i));
    EXPECT_EQ(from_message(decode<keyframe_t>(bytes)).chain, -1);
}

TEST(Decode, ACameraOfAnEarlierPlanemapHasNoLens) {
    const std::vector<std::uint8_t> today = encoded(to_message(test::sample_camera(), 1, 2));
    ASSERT_EQ(fingerprints<camera_info_t>().size(), 3u);
    for (const auto& [number, missing] : {std::pair(1, 10), std::pair(2, 75)}) {  // lenses; session and mount
        std::vector<std::uint8_t> earlier = today;
        earlier.resize(earlier.size() - static_cast<std::size_t>(missing));
        const std::uint64_t fingerprint = fingerprints<camera_info_t>().at(static_cast<std::size_t>(number));
        for (std::size_t i = 0; i < 8; ++i)
            earlier[i] = static_cast<std::uint8_t>(fingerprint >> (56 - 8 * i));
        EXPECT_EQ(from_message(decode<camera_info_t>(earlier)), test::sample_camera());
        for (std::size_t length = 0; length < earlier.size(); ++length)
            EXPECT_THROW(decode<camera_info_t>(std::span(earlier).first(length)), MessageError) << length;
    }
}

TEST(Decode, HugeLengthIsRefusedBeforeAllocation) {
    std::vector<std::uint8_t> bytes = encoded(to_message(sample_trajectory(), 1));
    const std::size_t at = 8 + 8 + 12 + 56;  // n_keyframes
    bytes[at] = 0x1f;
    bytes[at + 1] = bytes[at + 2] = bytes[at + 3] = 0xff;
    try {
        decode<trajectory_t>(bytes);
        FAIL() << "accepted";
    } catch (const MessageError& error) {
        EXPECT_NE(std::string(error.what()).find("keyframes has 536870911 elements"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace planemap::messages
