// SPDX-License-Identifier: BSD-3-Clause
#include "messages/frame_decoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/depth_correction.hpp"
#include "core/undistortion.hpp"
#include "messages/channels.hpp"
#include "messages/image_codec.hpp"
#include "messages/sample_messages.hpp"
#include "messages/told_status.hpp"

namespace planemap::messages {
namespace {

using test::encoded;
using test::sample_camera;

bot_core::images_t frame_message(const DepthImage& depth, const RgbImage& color, ColorEncoding c,
                                 DepthEncoding d) {
    bot_core::images_t images;
    images.utime = 50;
    images.image_types = {bot_core::images_t::LEFT, d == DepthEncoding::kRaw
                                                        ? std::int16_t{bot_core::images_t::DEPTH_MM}
                                                        : std::int16_t{bot_core::images_t::DEPTH_MM_ZIPPED}};
    images.images = {color_image_message(color, 40, c, 95), depth_image_message(depth, 50, d)};
    set_seq(images.images.back(), 17);
    images.n_images = 2;
    return images;
}

RawMessage raw(const std::vector<std::uint8_t>& bytes) {
    return {channels::kFrame, bytes, 0};
}

TEST(FrameDecoder, AllEncodingsGiveTheSameFrame) {
    Bus bus("memq://");
    FrameDecoder decoder(bus, sample_camera());
    const DepthImage depth(64, 48, 1234);
    const RgbImage color(64, 48, Rgb{100, 100, 100});
    for (const auto c : {ColorEncoding::kRaw, ColorEncoding::kJpeg}) {
        for (const auto d : {DepthEncoding::kRaw, DepthEncoding::kZipped}) {
            const auto bytes = encoded(frame_message(depth, color, c, d));
            const auto frame = decoder.decode(raw(bytes));
            ASSERT_NE(frame, nullptr);
            EXPECT_EQ(frame->utime(), 50);
            EXPECT_EQ(frame->color_utime(), 40);
            EXPECT_EQ(frame->seq(), 17u);
            EXPECT_EQ(frame->depth().pixels, depth.pixels);
            ASSERT_NE(frame->gray(), nullptr);
            for (const auto g : frame->gray()->pixels) EXPECT_NEAR(g, 100, 1);
        }
    }
}

/// A decoder with a subscriber, and what reached that.
class Subscribed : public testing::Test {
  protected:
    Subscribed() {
        decoder_.subscribe(status_, 8, [this](auto frame) { frames_.push_back(std::move(frame)); });
        publish(camera_);
    }
    static CameraInfo sample(double fx) {
        CameraInfo camera = sample_camera();
        camera.depth.fx = camera.color.fx = fx;
        return camera;
    }
    void publish(const CameraInfo& camera) {
        bus_.publish(channels::kCameraInfo, to_message(camera, 0, 0));
        bus_.drain();
    }
    struct Sent {
        std::int64_t utime;
        std::uint32_t seq;
        std::optional<std::uint64_t> sender = std::nullopt;
        int width = 64;
        int level = 900;
    };
    void publish(const Sent& sent) {
        auto message = frame_message(DepthImage(sent.width, 48, static_cast<std::uint16_t>(sent.level)),
                                     RgbImage(sent.width, 48), ColorEncoding::kRaw, DepthEncoding::kRaw);
        message.utime = sent.utime;
        message.images[1].metadata.clear();
        set_seq(message.images[1], sent.seq);
        if (sent.sender) set_sender(message.images[1], *sent.sender);
        bus_.publish(channels::kFrame, message);
        bus_.drain();
    }
    std::int64_t lost(const std::string& what) const {
        const auto found = status_.losses().find(what);
        return found == status_.losses().end() ? 0 : found->second;
    }

    Bus bus_{"memq://"};
    CameraInfo camera_ = sample(50), other_camera_ = sample(60);
    ModuleStatus status_{"odometry"};
    FrameDecoder decoder_{bus_};
    std::vector<std::shared_ptr<const Frame>> frames_;
};

TEST_F(Subscribed, TakeOverWhatWasMadeAheadOfTheSameImagesAndCameraAlone) {
    struct Made {
        int number;
    };
    const auto images_of = [](std::int64_t utime, std::uint16_t level) {
        auto images = frame_message(DepthImage(64, 48, level), RgbImage(64, 48), ColorEncoding::kRaw,
                                    DepthEncoding::kRaw);
        images.utime = utime;
        images.images[1].metadata.clear();  // its number and sender are not known yet
        return images;
    };
    const auto expect = [&](std::int64_t utime, std::uint16_t level,
                            std::shared_ptr<const Undistortion> camera) {
        const std::shared_ptr<Frame> prepared = decoder_.prepare(images_of(utime, level), std::move(camera));
        const DepthImage* const depth = &prepared->depth();
        prepared->keep(Made{7});
        decoder_.expect(prepared);
        return depth->pixels.data();
    };
    const std::shared_ptr<const Undistortion> camera = decoder_.camera_in_use();
    const std::uint16_t* const pixels = expect(100, 900, camera);
    publish(Sent{.utime = 100, .seq = 0});
    ASSERT_NE(frames_.back()->made<Made>(), nullptr);
    EXPECT_EQ(frames_.back()->made<Made>()->number, 7);
    EXPECT_EQ(frames_.back()->depth().pixels.data(), pixels) << "decoded once";
    EXPECT_EQ(frames_.back()->seq(), 0u);
    EXPECT_EQ(frames_.back()->made<int>(), nullptr);

    publish(Sent{.utime = 200, .seq = 1});
    EXPECT_EQ(frames_.back()->made<Made>(), nullptr) << "it is for one message";
    expect(300, 901, camera);
    publish(Sent{.utime = 300, .seq = 2});
    EXPECT_EQ(frames_.back()->made<Made>(), nullptr) << "another depth image";
    EXPECT_EQ(frames_.back()->depth().pixels.front(), 900);
    expect(401, 900, camera);
    publish(Sent{.utime = 400, .seq = 3});
    EXPECT_EQ(frames_.back()->made<Made>(), nullptr) << "another moment";
    expect(500, 900, std::make_shared<const Undistortion>(other_camera_));
    publish(Sent{.utime = 500, .seq = 4});
    EXPECT_EQ(frames_.back()->made<Made>(), nullptr) << "another camera";
    EXPECT_EQ(frames_.size(), 5u);
    frames_.clear();
    decoder_.expect(nullptr);
    EXPECT_EQ(decoder_.times().decode_ms.count(), 5) << "what was in vain took time, too";
}

TEST_F(Subscribed, ShareAFrameAndTheTroubleOfOneIsNotTheNexts) {
    ModuleStatus second("octomap"), third("segmentation");
    std::shared_ptr<const Frame> shared, last;
    decoder_.subscribe(
        second, 8,
        [&](auto frame) {
            shared = frame;
            throw MessageError("no");
        },
        false);
    decoder_.subscribe(third, 8, [&](auto frame) { last = frame; });
    publish({1000, 0});
    ASSERT_EQ(frames_.size(), 1u);
    EXPECT_EQ(shared.get(), frames_[0].get());
    EXPECT_EQ(last.get(), frames_[0].get());
    EXPECT_EQ(&shared->depth(), &last->depth());
    EXPECT_EQ(test::told(status_).received, 1);
    EXPECT_EQ(status_.decode_error_count(), 0);
    EXPECT_EQ(test::told(second).received, 0) << "frames are not its main stream";
    EXPECT_EQ(second.decode_error_count(), 1);
    EXPECT_EQ(bus_.complaints().count(), 1);
}

TEST_F(Subscribed, LateAndRepeatedFramesAndStampsThatGoBackAreCountedApart) {
    for (const std::uint32_t i : {0u, 1u, 3u, 2u, 4u, 4u, 5u})
        publish({1000000 + 33333 * std::int64_t{i}, i});
    EXPECT_EQ(frames_.size(), 5u);
    EXPECT_EQ(lost("frames that came late or twice"), 2);
    EXPECT_EQ(lost("frames whose stamp went back"), 0);
    for (std::uint32_t i = 6; i < 20; ++i) publish({1000000 - 33333 * std::int64_t{i}, i});
    EXPECT_EQ(frames_.size(), 5u);
    EXPECT_EQ(lost("frames whose stamp went back"), 14);
    EXPECT_EQ(test::told(status_).dropped, 16);
    EXPECT_EQ(test::told(status_).received, 21);
}

TEST_F(Subscribed, StampsAtTheEndsOfTheirRangeAreErrors) {
    publish({1000000, 0});
    for (const std::int64_t utime : {INT64_MIN, INT64_MAX, (std::int64_t{1} << 60) + 1})
        for (std::uint32_t i = 1; i < 4; ++i) publish({utime, i});
    publish(other_camera_);  // another description looks at stamps, too
    publish({INT64_MIN, 4});
    EXPECT_EQ(status_.decode_error_count(), 10);
    EXPECT_EQ(bus_.complaints().count(), 10);
    publish({1033333, 5});
    EXPECT_EQ(frames_.size(), 2u) << "the stream goes on";

    auto message =
        frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw);
    message.utime = 1066666;
    message.images[0].utime = INT64_MIN;
    bus_.publish(channels::kFrame, message);
    bus_.drain();
    EXPECT_EQ(status_.decode_error_count(), 11) << "odometry takes the colour image's time";
}

TEST_F(Subscribed, TheSecondOfTwoSendersIsIgnoredWhileTheFirstLives) {
    for (int i = 0; i < 100; ++i) {
        const auto seq = static_cast<std::uint32_t>(i);
        publish({1000000 + 33333 * i, seq, 1});
        publish({1007000 + 33333 * i, seq, 2, i % 2 == 0 ? 64 : 32});
    }
    ASSERT_EQ(frames_.size(), 100u);
    for (const auto& frame : frames_) EXPECT_EQ((frame->utime() - 1000000) % 33333, 0);
    EXPECT_EQ(lost("frames of another sender"), 100);
    EXPECT_EQ(status_.decode_error_count(), 0) << "of whatever size its images are";
}

/// With stamps that go on or jump, to either side: what is said from then on is not of the same run.
TEST_F(Subscribed, ARestartedSensorIsSaid) {
    std::int64_t utime = 1000000;
    for (std::uint32_t i = 0; i < 10; ++i) publish({utime += 33333, i, 1});
    EXPECT_TRUE(status_.remarks().empty());
    std::uint64_t sender = 1;
    for (const std::int64_t jump : std::initializer_list<std::int64_t>{33333, 3600000000, -1800000000}) {
        utime += jump;
        ++sender;
        const std::size_t before = frames_.size();
        for (std::uint32_t i = 0; i < 100; ++i) publish({utime += 33333, i, sender});
        ASSERT_GT(frames_.size(), before) << "followed after two seconds of silence of the first";
        ASSERT_EQ(status_.remarks().size(), 1u);
        EXPECT_NE(status_.remarks()[0].find("the sensor started again"), std::string::npos);
        char when[32];
        std::snprintf(when, sizeof(when), "at %.3f s", 1e-6 * static_cast<double>(frames_[before]->utime()));
        EXPECT_NE(status_.remarks()[0].find(when), std::string::npos) << status_.remarks()[0] << when;
    }
}

TEST_F(Subscribed, AnotherCameraIsNotTakenWhileTheFirstIsDescribed) {
    for (int i = 0; i < 150; ++i) {
        if (i % 30 == 0) publish(camera_);
        if (i % 30 == 15) publish(other_camera_);
        publish({1000000 + 33333 * i, static_cast<std::uint32_t>(i), 1});
    }
    for (const auto& frame : frames_) EXPECT_EQ(frame->camera().depth.fx, 50);
    EXPECT_EQ(frames_.size(), 150u);
    // The first is described no more: after two seconds the other one is.
    publish(other_camera_);
    for (int i = 150; i < 250; ++i) publish({1000000 + 33333 * i, static_cast<std::uint32_t>(i), 1});
    EXPECT_EQ(frames_[160]->camera().depth.fx, 50);
    EXPECT_EQ(frames_.back()->camera().depth.fx, 60);
}

TEST_F(Subscribed, AnotherCameraIsTakenWithItsFrames) {
    for (int i = 0; i < 30; ++i) publish({1000000 + 33333 * i, static_cast<std::uint32_t>(i)});
    // A second log behind the first: time starts again.
    publish(other_camera_);
    for (int i = 0; i < 30; ++i)
        publish({500000 + 33333 * i, static_cast<std::uint32_t>(i), std::nullopt, 64, 800});
    ASSERT_GE(frames_.size(), 55u);
    for (const auto& frame : frames_)
        EXPECT_EQ(frame->camera().depth.fx, frame->depth()(0, 0) == 900 ? 50 : 60);
    // Images of another size, in the stream as it is.
    CameraInfo small = sample(25);
    small.depth.width = small.color.width = 32;
    publish(small);
    publish({1500000, 30, std::nullopt, 32});
    EXPECT_EQ(frames_.back()->camera().depth.width, 32);
}

TEST_F(Subscribed, FramesBeforeTheCameraAreCounted) {
    Bus bus("memq://");
    FrameDecoder decoder(bus);
    ModuleStatus status("odometry");
    decoder.subscribe(status, 8, [](const auto&) { FAIL(); });
    bus.publish(channels::kFrame, frame_message(DepthImage(64, 48, 900), RgbImage(64, 48),
                                                ColorEncoding::kRaw, DepthEncoding::kRaw));
    bus.drain();
    EXPECT_EQ(test::told(status).received, 1);
    EXPECT_EQ(test::told(status).dropped, 1);
    EXPECT_EQ(status.losses().size(), 1u);
}

TEST(FrameDecoder, WaitsForTheCameraAndTakesItFromTheBus) {
    Bus bus("memq://");
    FrameDecoder decoder(bus);
    const auto bytes = encoded(
        frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw));
    EXPECT_EQ(decoder.decode(raw(bytes)), nullptr);
    bus.publish(channels::kCameraInfo, to_message(sample_camera(), 1, 0));
    bus.drain();
    EXPECT_NE(decoder.decode(raw(bytes)), nullptr);
}

TEST(FrameDecoder, RegistersUnregisteredDepthOnce) {
    Bus bus("memq://");
    CameraInfo camera = sample_camera();
    camera.registered = false;
    camera.color_from_depth.translation() = Eigen::Vector3d(0.1, 0, 0);
    FrameDecoder decoder(bus, camera);
    const auto bytes = encoded(
        frame_message(DepthImage(64, 48, 1000), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw));
    const auto frame = decoder.decode(raw(bytes));
    // 0.1 m at 1 m with a focal length of 50 pixels: a shift of 5 pixels.
    EXPECT_EQ(frame->depth_in_color()(4, 10), 0);
    EXPECT_EQ(frame->depth_in_color()(5, 10), 1000);
    EXPECT_EQ(&frame->depth_in_color(), &frame->depth_in_color());
}

CameraInfo bent_camera() {
    CameraInfo camera = sample_camera();
    camera.depth_distortion = camera.color_distortion =
        LensDistortion{LensDistortion::Model::kBrown, {-0.25, 0, 0.01, 0}};
    return camera;
}

/// Images that say where their pixels are.
std::pair<DepthImage, RgbImage> slopes() {
    DepthImage depth(64, 48);
    RgbImage color(64, 48);
    for (int v = 0; v < 48; ++v) {
        for (int u = 0; u < 64; ++u) {
            depth(u, v) = static_cast<std::uint16_t>(1000 + 100 * u + v);
            color(u, v) = {static_cast<std::uint8_t>(4 * u), static_cast<std::uint8_t>(4 * u),
                           static_cast<std::uint8_t>(4 * u)};
        }
    }
    return {depth, color};
}

TEST(FrameDecoder, UndoesTheLensOnce) {
    Bus bus("memq://");
    FrameDecoder decoder(bus);
    bus.publish(channels::kCameraInfo, to_message(bent_camera(), 1, 0));
    bus.drain();
    ASSERT_NE(decoder.camera(), nullptr);
    EXPECT_EQ(*decoder.camera(), bent_camera());
    auto [depth, color] = slopes();
    for (const auto c : {ColorEncoding::kRaw, ColorEncoding::kJpeg}) {
        const auto bytes = encoded(frame_message(depth, color, c, DepthEncoding::kZipped));
        const auto frame = decoder.decode(raw(bytes));
        EXPECT_EQ(frame->camera(), sample_camera()) << "a pinhole";
        EXPECT_EQ(frame->sensed_camera(), bent_camera());
        DepthImage expected = depth;
        GrayImage gray = luma(color);
        const Undistortion undistortion(bent_camera());
        undistortion.undistort(expected);
        undistortion.undistort(gray);
        EXPECT_NE(expected.pixels, depth.pixels);
        EXPECT_EQ(frame->depth().pixels, expected.pixels);
        EXPECT_EQ(frame->depth_in_color().pixels, expected.pixels);
        EXPECT_EQ(frame->depth().pixels, expected.pixels) << "and not again";
        for (std::size_t i = 0; i < gray.pixels.size(); ++i)
            ASSERT_NEAR(frame->gray()->pixels[i], gray.pixels[i], 3);
        const auto small = frame->color(2);
        ASSERT_TRUE(small);
        EXPECT_NEAR((*small)(30, 2).r, frame->gray()->row(4)[60], 12) << "previews, too";
    }
}

TEST(FrameDecoder, CorrectsReadingsWhereTheyWereSensed) {
    Bus bus("memq://");
    CameraInfo camera = bent_camera();
    camera.depth_correction.emplace();
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        camera.depth_correction->offsets[i] = 0.002 * static_cast<double>(i);
    FrameDecoder decoder(bus, camera);
    auto [expected, color] = slopes();
    const auto bytes = encoded(frame_message(expected, color, ColorEncoding::kRaw, DepthEncoding::kRaw));
    correct_depth(expected, camera);
    Undistortion(camera).undistort(expected);
    EXPECT_EQ(decoder.decode(raw(bytes))->depth().pixels, expected.pixels);
}

TEST(FrameDecoder, WhatColourDoesNotShowHasNoDepthInIt) {
    Bus bus("memq://");
    CameraInfo camera = sample_camera();
    camera.registered = false;
    camera.color_distortion = LensDistortion{LensDistortion::Model::kBrown, {0.4, 0, 0, 0}};
    FrameDecoder decoder(bus, camera);
    const auto bytes = encoded(
        frame_message(DepthImage(64, 48, 1000), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw));
    const auto frame = decoder.decode(raw(bytes));
    EXPECT_EQ(frame->depth()(0, 0), 1000);
    EXPECT_EQ(frame->depth_in_color()(0, 0), 0);
    EXPECT_EQ(frame->depth_in_color()(32, 24), 1000);
}

TEST(FrameDecoder, FramesThatDoNotAddUpAreErrors) {
    Bus bus("memq://");
    FrameDecoder decoder(bus, sample_camera());
    const auto refused = [&](const std::function<void(bot_core::images_t&)>& spoil,
                             DepthEncoding d = DepthEncoding::kRaw, ColorEncoding c = ColorEncoding::kRaw) {
        auto message = frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), c, d);
        spoil(message);
        const auto bytes = encoded(message);
        EXPECT_THROW(
            {
                const auto frame = decoder.decode(raw(bytes));
                frame->depth();
                frame->gray();
            },
            MessageError);
    };
    const auto shrink = [](bot_core::image_t& image) {
        image.data.resize(image.data.size() / 2);
        image.size = static_cast<std::int32_t>(image.data.size());
    };
    refused([](auto& m) { m.image_types[1] = bot_core::images_t::DISPARITY; });
    refused([](auto& m) { m.images[1].width = 640; });
    refused([](auto& m) { m.images[1].width = -64; });
    refused([](auto& m) { m.images[1].row_stride = 1; });
    refused([](auto& m) { m.images[1].row_stride = 0x7fffffff; });
    refused([](auto& m) { m.images[1].pixelformat = 0; });
    refused([&](auto& m) { shrink(m.images[1]); });
    refused([&](auto& m) { shrink(m.images[1]); }, DepthEncoding::kZipped);
    refused([](auto& m) { m.images[0].height = 47; });
    refused([](auto& m) { m.images[0].pixelformat = 123; });
    refused([&](auto& m) { shrink(m.images[0]); });
    refused([&](auto& m) { shrink(m.images[0]); }, DepthEncoding::kRaw, ColorEncoding::kJpeg);
}

}  // namespace
}  // namespace planemap::messages
