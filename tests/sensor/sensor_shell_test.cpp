// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_shell.hpp"

#include <filesystem>

#include "messages/log.hpp"
#include "sensor/temporary_folder.hpp"
#include "shell_fixture.hpp"

namespace planemap {
namespace {

/// Ten frames 0.3 s apart; the third is broken, the fifth has lost its colour.
class FakeSource : public FrameSource {
  public:
    explicit FakeSource(CameraInfo camera) : camera_(std::move(camera)) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return 10; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        const int index = next_++;
        if (index == 10) return {};
        if (index == 2) return {ReadResult::Status::kBroken, "depth/2.png: cut short"};
        frame.utime = 1000000 + 300000 * index;
        frame.depth =
            DepthImage(camera_.depth.width, camera_.depth.height, static_cast<std::uint16_t>(1000 + index));
        if (index == 4) return {ReadResult::Status::kFrame, "rgb/4.jpg: cut short"};
        frame.color_utime = frame.utime - 5000;
        frame.color = RgbImage(camera_.color.width, camera_.color.height, Rgb{10, 20, 30});
        return {ReadResult::Status::kFrame, ""};
    }

  private:
    CameraInfo camera_;
    int next_ = 0;
};

class SensorShellTest : public test::ShellTest {
  protected:
    static SensorShellOptions fast(const std::string& encoding_color, const std::string& encoding_depth) {
        SensorShellOptions options;
        options.speed = 0;
        options.color = encoding_color;
        options.depth = encoding_depth;
        return options;
    }
};

TEST_F(SensorShellTest, PublishesEveryFrameInEveryEncoding) {
    for (const char* color : {"jpeg", "raw"}) {
        for (const char* depth : {"zipped", "raw"}) {
            Bus bus("memq://");
            SensorShell shell(bus, std::make_unique<FakeSource>(camera()), fast(color, depth));
            FrameDecoder decoder(bus);
            std::vector<std::shared_ptr<const Frame>> frames;
            int cameras = 0;
            bus.subscribe(channels::kFrame,
                          [&](const RawMessage& m) { frames.push_back(decoder.decode(m)); });
            bus.subscribe(channels::kCameraInfo, [&](const RawMessage&) { ++cameras; });
            while (shell.poll() >= 0) bus.drain();
            ASSERT_EQ(frames.size(), 9u);
            EXPECT_EQ(cameras, 3) << "at the start and once a second";
            EXPECT_EQ(frames[2]->depth()(0, 0), 1003) << "after the broken one";
            EXPECT_EQ(frames[8]->seq(), 8u);
            EXPECT_FALSE(frames[3]->has_color());
            EXPECT_EQ(frames[1]->color_utime(), 1295000);
            EXPECT_NEAR((*frames[1]->gray())(5, 5), 18, 2);
            EXPECT_EQ(shell.broken(), 1);
            EXPECT_EQ(shell.colorless(), 1);
        }
    }
}

TEST_F(SensorShellTest, OnASharedBusFramesTellTheirSender) {
    const TemporaryFolder folder;
    const auto first_frame = [&](const std::string& url) {
        const std::filesystem::path file = folder.path() / "sensor.lcmlog";
        {
            Bus bus(url);
            bot_core::images_t first;
            if (bus.in_process())
                bus.subscribe(channels::kFrame,
                              [&](const RawMessage& m) { first = decode<bot_core::images_t>(m.bytes); });
            SensorShell shell(bus, std::make_unique<FakeSource>(camera()), fast("raw", "raw"));
            shell.poll();
            if (bus.in_process()) {
                bus.drain();
                return first;
            }
        }
        LogReader log(file);
        LogEvent event;
        while (log.next(event) && event.channel != channels::kFrame) {
        }
        return decode<bot_core::images_t>(event.bytes);
    };
    const std::string shared = "file://" + (folder.path() / "sensor.lcmlog").string() + "?mode=w";
    const auto one = first_frame(shared).images.back().metadata,
               other = first_frame(shared).images.back().metadata;
    ASSERT_EQ(one.size(), 2u);
    EXPECT_EQ(one[1].key, "sender");
    EXPECT_EQ(one[1].value.size(), 8u);
    EXPECT_NE(one[1].value, other.at(1).value);
    EXPECT_EQ(first_frame("memq://").images.back().metadata.size(), 1u)
        << "the same bytes again in one process";
}

TEST_F(SensorShellTest, KeepsTheRecordedPace) {
    SensorShellOptions options;
    options.speed = 30;  // 2.7 s of frames in 90 ms
    SensorShell shell(bus_, std::make_unique<FakeSource>(camera()), options);
    const std::int64_t start = now_us();
    while (true) {
        const int wait_ms = shell.poll();
        if (wait_ms < 0) break;
        if (wait_ms > 0) bus_.handle(wait_ms);
    }
    EXPECT_GE(now_us() - start, 80000);
}

TEST_F(SensorShellTest, BadOptionsAreNamed) {
    SensorShellOptions options;
    options.rate_hz = -1;
    options.color = "png";
    try {
        SensorShell shell(bus_, std::make_unique<FakeSource>(camera()), options);
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("rate"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("color"), std::string::npos);
    }
}

}  // namespace
}  // namespace planemap
