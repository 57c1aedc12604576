// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/log.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

class LogInputTest : public testing::Test {
  protected:
    LogInputTest() {
        camera_.depth = camera_.color = {64, 48, 50, 50, 31.5, 23.5};
        bus_.subscribe(".*",
                       [this](const messages::RawMessage& m) { seen_.push_back(std::string(m.channel)); });
    }
    ~LogInputTest() override { std::filesystem::remove(file_); }

    template <typename T>
    void add(messages::LogWriter& log, const char* channel, const T& message) {
        messages::LogEvent event{
            number_++, number_ * 1000, channel,
            std::vector<std::uint8_t>(static_cast<std::size_t>(message.getEncodedSize()))};
        message.encode(event.bytes.data(), 0, message.getEncodedSize());
        log.write(event);
    }
    static bot_core::images_t frame(bool depth) {
        bot_core::images_t images;
        images.image_types = {depth ? std::int16_t{bot_core::images_t::DEPTH_MM}
                                    : std::int16_t{bot_core::images_t::LEFT}};
        images.images = {
            depth ? messages::depth_image_message(DepthImage(64, 48), 1, messages::DepthEncoding::kRaw)
                  : messages::color_image_message(RgbImage(64, 48), 1, messages::ColorEncoding::kRaw, 90)};
        images.n_images = 1;
        return images;
    }
    int feed(Input& input) {
        int frames = 0;
        while (input.feed()) ++frames;
        bus_.drain();
        return frames;
    }
    std::string error() {
        try {
            open_input(file_, bus_);
            return {};
        } catch (const std::runtime_error& error) {
            return error.what();
        }
    }

    messages::Bus bus_{"memq://"};
    CameraInfo camera_;
    std::vector<std::string> seen_;
    std::int64_t number_ = 0;
    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("planemap_input_test_" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(LogInputTest, TheChannelWithDepthIsReadAndTheOthersAreNamed) {
    messages::LogWriter log(file_);
    add(log, messages::channels::kCameraInfo, messages::to_message(camera_, 0, 0));
    add(log, "WEBCAM", frame(false));
    add(log, "HEAD", frame(false));  // as heads send it before the depth camera's first message
    for (int i = 0; i < 3; ++i) {
        add(log, "HEAD", frame(true));
        add(log, "WEBCAM", frame(false));
    }
    log.close();
    const auto input = open_input(file_, bus_);
    EXPECT_EQ(feed(*input), 4);
    ASSERT_EQ(input->complaints().size(), 1u);
    EXPECT_EQ(input->complaints()[0],
              "frames of other channels than HEAD are not read: WEBCAM bot_core.images_t (4)");
    EXPECT_EQ(std::count(seen_.begin(), seen_.end(), std::string(messages::channels::kFrame)), 4);
}

TEST_F(LogInputTest, ABadCameraDescriptionIsNamedWithItsReason) {
    CameraInfo bad = camera_;
    bad.depth.fx = -3;
    messages::LogWriter log(file_);
    add(log, messages::channels::kCameraInfo, messages::to_message(bad, 0, 0));
    add(log, messages::channels::kFrame, frame(true));
    add(log, messages::channels::kCameraInfo, messages::to_message(bad, 0, 1));
    log.close();
    const std::string said = error();
    EXPECT_EQ(said.rfind(file_.string() + ": none of the 2 camera_info_t in this log can be used (", 0), 0u)
        << said;
    EXPECT_NE(said.find("fx"), std::string::npos) << said;
    EXPECT_NE(said.find("-3"), std::string::npos) << said;
    EXPECT_NO_THROW(open_input(file_, bus_, {.camera = camera_})) << "one that is given does";
}

TEST_F(LogInputTest, AFileThatIsNoLogSaysSoAndOneOfARecordingNamesItsFolder) {
    write_file(file_, "# timestamp filename\n1.0 rgb/1.png\n");
    EXPECT_EQ(error(), file_.string() + ": is no LCM log");
    const test::TemporaryFolder folder;
    write_file(folder / "rgb.txt", "1.0 rgb/1.png\n");
    write_file(folder / "depth.txt", "1.0 depth/1.png\n");
    file_ = folder / "rgb.txt";
    EXPECT_EQ(error(), file_.string() + ": is no LCM log; give its folder, " + folder.path().string());
}

TEST_F(LogInputTest, ColourAloneIsNoRecording) {
    messages::LogWriter log(file_);
    add(log, messages::channels::kCameraInfo, messages::to_message(camera_, 0, 0));
    for (int i = 0; i < 3; ++i) add(log, "WEBCAM", frame(false));
    log.close();
    const std::string said = error();
    EXPECT_NE(said.find("no camera frames with depth"), std::string::npos) << said;
    EXPECT_NE(said.find("PLANEMAP_CAMERA_INFO planemap.camera_info_t (1), WEBCAM bot_core.images_t (3)"),
              std::string::npos)
        << said;
}

/// What was read before stays; why it ended is said.
TEST_F(LogInputTest, ALogThatCannotBeReadOnEndsTheInputWithItsReason) {
    messages::LogWriter log(file_);
    add(log, messages::channels::kCameraInfo, messages::to_message(camera_, 0, 0));
    for (int i = 0; i < 200; ++i) add(log, messages::channels::kFrame, frame(true));
    log.close();
    const auto input = open_input(file_, bus_);
    ASSERT_TRUE(input->feed());
    EXPECT_EQ(input->failure(), "");
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
    EXPECT_LT(feed(*input), 150);
    EXPECT_EQ(input->failure().rfind(file_.string() + ": became shorter while it was read", 0), 0u)
        << input->failure();
}

}  // namespace
}  // namespace planemap
