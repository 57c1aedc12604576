// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_shell.hpp"

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <thread>

#include "messages/log.hpp"
#include "messages/tcpq_server.hpp"
#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
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
        if (index == 4) {
            ReadResult result{ReadResult::Status::kFrame, "rgb/4.jpg: cut short"};
            result.color_left_out = true;
            return result;
        }
        frame.color_utime = frame.utime - 5000;
        frame.color = RgbImage(camera_.color.width, camera_.color.height, Rgb{10, 20, 30});
        return {ReadResult::Status::kFrame, ""};
    }

  private:
    CameraInfo camera_;
    int next_ = 0;
};

/// A live camera that is unplugged between its first frame and its second.
class UnpluggedSource : public FrameSource {
  public:
    explicit UnpluggedSource(CameraInfo camera) : camera_(std::move(camera)) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return std::nullopt; }
    bool is_live() const override { return true; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        const int index = next_++;
        if (index == 1 || index == 2) return {ReadResult::Status::kNothing, "Xtion: unplugged"};
        if (index == 4) return {};
        frame.utime = 1000000 + 33333 * index;
        frame.depth = DepthImage(camera_.depth.width, camera_.depth.height, 1000);
        ReadResult result{ReadResult::Status::kFrame, ""};
        result.lost["frames that the camera did not send"] = 3;
        return result;
    }

  private:
    CameraInfo camera_;
    int next_ = 0;
};

/// Frames of one pixel's worth at given stamps, which may wait before one of them.
class StampedSource : public FrameSource {
  public:
    StampedSource(CameraInfo camera, std::vector<std::int64_t> stamps, std::size_t slow = 0, int slow_ms = 0)
        : camera_(std::move(camera)), stamps_(std::move(stamps)), slow_(slow), slow_ms_(slow_ms) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return stamps_.size(); }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        if (slow_ms_ > 0 && next_ == slow_) {
            std::this_thread::sleep_for(std::chrono::milliseconds(slow_ms_));
        }
        if (next_ == stamps_.size()) return {};
        frame.utime = stamps_[next_++];
        frame.depth = DepthImage(camera_.depth.width, camera_.depth.height, 1000);
        return {ReadResult::Status::kFrame, ""};
    }

  private:
    CameraInfo camera_;
    std::vector<std::int64_t> stamps_;
    std::size_t slow_, next_ = 0;
    int slow_ms_;
};

/// A source of nothing but faults.
class BrokenSource : public FrameSource {
  public:
    explicit BrokenSource(CameraInfo camera, int frames) : camera_(std::move(camera)), left_(frames) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return std::nullopt; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        if (left_-- <= 0) return {};
        const std::string file = "depth/" + std::to_string(left_) + ".png: ";
        const std::string reason = left_ % 2 == 0 ? "not a PNG" : "cannot open";
        ReadResult result{ReadResult::Status::kBroken, file + reason};
        result.reason = reason;
        return result;
    }
    std::vector<std::string> notes() const override { return {"a note of the source"}; }

  private:
    CameraInfo camera_;
    int left_;
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
            messages::Bus bus("memq://");
            SensorShell shell(bus, std::make_unique<FakeSource>(camera()), fast(color, depth));
            messages::FrameDecoder decoder(bus);
            std::vector<std::shared_ptr<const messages::Frame>> frames;
            int cameras = 0;
            bus.subscribe(messages::channels::kFrame,
                          [&](const messages::RawMessage& m) { frames.push_back(decoder.decode(m)); });
            bus.subscribe(messages::channels::kCameraInfo, [&](const messages::RawMessage&) { ++cameras; });
            while (shell.poll() >= 0) bus.drain();
            ASSERT_EQ(frames.size(), 9u);
            EXPECT_EQ(cameras, 3) << "at the start and once a second";
            EXPECT_EQ(frames[2]->depth()(0, 0), 1003) << "after the broken one";
            EXPECT_EQ(frames[8]->seq(), 8u);
            EXPECT_EQ(frames[3]->gray(), nullptr);
            EXPECT_EQ(frames[1]->color_utime(), 1295000);
            EXPECT_NEAR((*frames[1]->gray())(5, 5), 18, 2);
            EXPECT_EQ(shell.broken(), 1);
            EXPECT_EQ(shell.colorless(), 1);
        }
    }
}

TEST_F(SensorShellTest, OnASharedBusFramesTellTheirSender) {
    const test::TemporaryFolder folder;
    const auto first_frame = [&](const std::string& url) {
        const std::filesystem::path file = folder.path() / "sensor.lcmlog";
        {
            messages::Bus bus(url);
            bot_core::images_t first;
            if (bus.in_process())
                bus.subscribe(messages::channels::kFrame, [&](const messages::RawMessage& m) {
                    first = messages::decode<bot_core::images_t>(m.bytes);
                });
            SensorShell shell(bus, std::make_unique<FakeSource>(camera()), fast("raw", "raw"));
            shell.poll();
            if (bus.in_process()) {
                bus.drain();
                return first;
            }
        }
        messages::LogReader log(file);
        messages::LogEvent event;
        while (log.next(event) && event.channel != messages::channels::kFrame) {
        }
        return messages::decode<bot_core::images_t>(event.bytes);
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

/// How long a shell takes to its end, microseconds.
std::int64_t time_of(messages::Bus& bus, SensorShell shell) {
    const std::int64_t start = messages::now_us();
    while (true) {
        const int wait_ms = shell.poll();
        if (wait_ms < 0) break;
        if (wait_ms > 0) bus.handle(wait_ms);
    }
    return messages::now_us() - start;
}

TEST_F(SensorShellTest, KeepsTheRecordedPace) {
    SensorShellOptions options;
    options.speed = 30;  // 2.7 s of frames in 90 ms
    for (const bool restamp : {false, true}) {
        options.restamp = restamp;
        EXPECT_GE(time_of(bus_, SensorShell(bus_, std::make_unique<FakeSource>(camera()), options)), 80000)
            << (restamp ? "stamped anew" : "as recorded");
    }
}

/// Runs a shell to its end as a process does, and counts the camera messages.
int cameras_of(messages::Bus& bus, std::unique_ptr<FrameSource> source, const SensorShellOptions& options) {
    SensorShell shell(bus, std::move(source), options);
    int cameras = 0;
    bus.subscribe(messages::channels::kCameraInfo, [&](const messages::RawMessage&) { ++cameras; });
    while (true) {
        const int wait_ms = shell.poll();
        if (wait_ms < 0) break;
        bus.handle(std::min(wait_ms, 200));
    }
    bus.drain();
    return cameras;
}

std::vector<std::int64_t> stamps_every(std::int64_t step_us, int count) {
    std::vector<std::int64_t> stamps;
    for (int i = 0; i < count; ++i) stamps.push_back(1000000 + i * step_us);
    return stamps;
}

TEST_F(SensorShellTest, LiveTheCameraIsToldOnceASecondByTheWallClock) {
    SensorShellOptions options;
    options.live = true;
    options.rate_hz = 8;
    // 20 frames in 2.4 s, whatever the stamps say: 20 ms in all, or 3 minutes.
    for (const std::int64_t step_us : {1000, 10000000}) {
        messages::Bus bus("memq://");
        const int cameras =
            cameras_of(bus, std::make_unique<StampedSource>(camera(), stamps_every(step_us, 20)), options);
        EXPECT_GE(cameras, 2) << step_us;
        EXPECT_LE(cameras, 5) << step_us << ": a loaded machine may be late, but not by the stamps";
    }
}

TEST_F(SensorShellTest, LiveTheCameraIsToldWhileTheSourceBlocks) {
    SensorShellOptions options;
    options.live = true;
    options.speed = 0;
    for (const std::size_t slow : {0u, 2u}) {
        messages::Bus bus("memq://");
        const int cameras = cameras_of(
            bus, std::make_unique<StampedSource>(camera(), stamps_every(1000, 3), slow, 2500), options);
        EXPECT_GE(cameras, 2) << slow;
    }
}

TEST_F(SensorShellTest, NotLiveTheCameraGoesByTheStampsAlone) {
    SensorShellOptions options = fast("raw", "raw");
    EXPECT_EQ(
        cameras_of(bus_, std::make_unique<StampedSource>(camera(), stamps_every(10000, 3), 1, 1200), options),
        1);
    messages::Bus bus("memq://");
    EXPECT_EQ(cameras_of(bus, std::make_unique<StampedSource>(camera(), stamps_every(1000000, 5)), options),
              5);
}

TEST_F(SensorShellTest, LiveEveryFrameComesInOrder) {
    SensorShellOptions options = fast("raw", "raw");
    options.live = true;
    SensorShell shell(bus_, std::make_unique<StampedSource>(camera(), stamps_every(1000, 50)), options);
    messages::FrameDecoder decoder(bus_);
    std::vector<std::int64_t> utimes;
    bus_.subscribe(messages::channels::kFrame,
                   [&](const messages::RawMessage& m) { utimes.push_back(decoder.decode(m)->utime()); });
    while (shell.poll() >= 0) bus_.drain();
    EXPECT_EQ(utimes, stamps_every(1000, 50));
}

TEST_F(SensorShellTest, TheSameFaultIsSaidOnceThenCounted) {
    std::ostringstream log;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    SensorShell shell(bus_, std::make_unique<BrokenSource>(camera(), 10000), fast("raw", "raw"));
    while (shell.poll() >= 0) bus_.drain();
    spdlog::set_default_logger(before);
    EXPECT_EQ(shell.broken(), 10000);
    EXPECT_EQ(shell.status().losses().at("frames that cannot be read"), 10000);
    const std::string text = log.str();
    EXPECT_THAT(text, testing::HasSubstr("a note of the source"));
    EXPECT_THAT(text, testing::HasSubstr("depth/9998.png: not a PNG"));
    EXPECT_THAT(text, testing::HasSubstr("depth/9999.png: cannot open"));
    EXPECT_THAT(text, testing::HasSubstr("(1000 times so far)"));
    EXPECT_THAT(text, testing::Not(testing::HasSubstr("lost"))) << "each fault was said by its file";
    EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 20) << text;
}

TEST_F(SensorShellTest, ASourceWithoutOneGoodFrameEndsInAnError) {
    SensorShell broken(bus_, std::make_unique<BrokenSource>(camera(), 3), fast("raw", "raw"));
    broken.finish();  // stopped before the end: nothing to complain of
    while (broken.poll() >= 0) {
    }
    try {
        broken.finish();
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("none of the 3 frames"),
                                                 testing::HasSubstr("depth/2.png: not a PNG")));
    }
    SensorShell good(bus_, std::make_unique<FakeSource>(camera()), fast("raw", "raw"));
    while (good.poll() >= 0) {
    }
    EXPECT_NO_THROW(good.finish());
}

/// Without anybody to send to a recording waits; it does not make up for the time when it goes on.
TEST_F(SensorShellTest, ARecordingWaitsForAConnection) {
    auto server = std::make_unique<test::TcpqServer>();
    const std::uint16_t port = server->port();
    messages::Bus bus(server->url());
    SensorShellOptions options;
    options.speed = 3;  // a frame in 100 ms
    SensorShell shell(bus, std::make_unique<FakeSource>(camera()), options);
    const auto play = [&](auto until) {
        const std::int64_t start = messages::now_us();
        while (!until() && messages::now_us() - start < 8000000) {
            const int wait_ms = shell.poll();
            if (wait_ms < 0) return;
            bus.handle(std::max(1, std::min(wait_ms, 20)));
        }
    };
    play([&] { return shell.frames() == 2; });
    server.reset();
    play([&] { return !bus.connected(); });
    const std::int64_t lost_us = messages::now_us(), frames = shell.frames();
    play([&] { return messages::now_us() - lost_us > 700000; });
    EXPECT_EQ(shell.frames(), frames) << "nobody was there";
    server = std::make_unique<test::TcpqServer>(port);
    play([&] { return bus.connected(); });
    const std::int64_t again_us = messages::now_us();
    play([&] { return shell.frames() == 9; });
    EXPECT_EQ(shell.frames(), 9);
    EXPECT_GE(messages::now_us() - again_us, 100000 * (8 - frames)) << "at its pace";
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

TEST_F(SensorShellTest, AnUnpluggedCameraIsFailingUntilItsFramesComeAgain) {
    SensorShell shell(bus_, std::make_unique<UnpluggedSource>(camera()), {});
    std::vector<std::string> lines;
    while (shell.poll() >= 0) lines.push_back(shell.status().line());
    ASSERT_GE(lines.size(), 4u);
    EXPECT_THAT(lines[1],
                testing::AllOf(testing::HasSubstr("failing"), testing::HasSubstr("Xtion: unplugged")));
    EXPECT_THAT(lines.back(), testing::Not(testing::HasSubstr("unplugged")));
    EXPECT_EQ(shell.frames(), 2);
    EXPECT_EQ(shell.broken(), 0);
    EXPECT_EQ(shell.camera_losses().at("frames that the camera did not send"), 6);
}

}  // namespace
}  // namespace planemap::sensor
