// SPDX-License-Identifier: BSD-3-Clause
#include "camera/live_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace planemap::camera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Gives so many frames of one depth, and is unplugged then.
class FakeCamera : public LiveCamera {
  public:
    FakeCamera(int frames, int width) : frames_(frames) {
        info_.serial = "fake";
        info_.depth = info_.color = {width, 240, 280, 280, 159.5, 119.5};
    }
    const CameraInfo& info() const override { return info_; }
    std::string name() const override { return "Fake 7"; }
    std::string serial() const override { return "7"; }
    std::vector<std::string> notes() const override { return {}; }
    bool is_unplugged() const override { return frames_ == 0; }
    std::chrono::milliseconds silence() const override { return 0ms; }
    std::optional<LiveFrame> next(std::chrono::milliseconds, Losses& lost) override {
        if (frames_ == 0) return std::nullopt;
        --frames_;
        lost["frames of a kind"] = 2;
        stamp_us_ += 33333;
        return LiveFrame{stamp_us_, stamp_us_ + 5, wall_us(), DepthImage(info_.depth.width, 240, 1000),
                         RgbImage(info_.color.width, 240)};
    }

  private:
    CameraInfo info_;
    int frames_;
    std::int64_t stamp_us_ = 0;
};

TEST(LiveSource, IsOpenedAgainBySerialNumberAfterItWasUnplugged) {
    std::vector<std::string> opened;
    LiveSource source([&](const std::string& serial) {
        opened.push_back(serial);
        if (opened.size() == 2) throw std::runtime_error("no camera is plugged in");
        return std::make_unique<FakeCamera>(2, 320);
    });
    SensorFrame frame;
    std::int64_t last = 0;
    int frames = 0;
    std::vector<std::string> troubles;
    for (int i = 0; i < 60 && frames < 4; ++i) {
        const ReadResult result = source.next(frame);
        if (result.status == ReadResult::Status::kFrame) {
            ++frames;
            EXPECT_GT(frame.utime, last) << "the device's clock began again, the host's time did not";
            EXPECT_EQ(frame.color_utime, frame.utime + 5);
            EXPECT_EQ(result.lost.at("frames of a kind"), 2);
            EXPECT_EQ(
                result.lost.count("synchronisations with the camera's clock, which began again or jumped"),
                frames == 3 ? 1u : 0u)
                << frames;
            last = frame.utime;
        } else {
            ASSERT_EQ(result.status, ReadResult::Status::kNothing);
            if (troubles.empty() || troubles.back() != result.message) troubles.push_back(result.message);
        }
    }
    EXPECT_EQ(frames, 4);
    EXPECT_EQ(opened, (std::vector<std::string>{"", "7", "7"}));
    EXPECT_THAT(troubles,
                testing::ElementsAre("Fake 7: unplugged", "Fake 7 is away: no camera is plugged in"));
}

TEST(LiveSource, AnotherCameraIsNotTakenForIt) {
    int opened = 0;
    LiveSource source(
        [&](const std::string&) { return std::make_unique<FakeCamera>(1, opened++ == 0 ? 320 : 640); });
    SensorFrame frame;
    std::string last;
    for (int i = 0; i < 15; ++i) last = source.next(frame).message;
    EXPECT_GE(opened, 2);
    EXPECT_THAT(last, HasSubstr("came back as another camera"));
}

/// Records, which fails with the second frame; and once more at the end, which nobody need hear.
class FakeRecordingCamera : public FakeCamera {
  public:
    FakeRecordingCamera() : FakeCamera(4, 320) {}
    std::optional<LiveFrame> next(std::chrono::milliseconds wait, Losses& lost) override {
        if (++asked_ == 2) fault_ = "a.oni: the recording ends here";
        return FakeCamera::next(wait, lost);
    }
    void end_recording() override { fault_ += ", again"; }
    std::string fault() const override { return fault_; }

  private:
    int asked_ = 0;
    std::string fault_;
};

TEST(LiveSource, ARecordingThatFailsIsToldOnceAndAtTheEnd) {
    LiveSource source([&](const std::string&) { return std::make_unique<FakeRecordingCamera>(); });
    SensorFrame frame;
    std::vector<std::string> beside;
    for (int i = 0; i < 4; ++i) {
        const ReadResult result = source.next(frame);
        EXPECT_EQ(result.status, ReadResult::Status::kFrame);
        beside.push_back(result.beside);
    }
    EXPECT_THAT(beside, testing::ElementsAre("", "a.oni: the recording ends here", "", ""));
    EXPECT_EQ(source.end(), "a.oni: the recording ends here");
}

TEST(LiveSource, ARecordingThatCannotBeClosedIsTold) {
    LiveSource source([&](const std::string&) { return std::make_unique<FakeRecordingCamera>(); });
    EXPECT_EQ(source.end(), ", again");
}

TEST(LiveSource, ThatCannotBeOpenedSaysWhy) {
    EXPECT_THROW(LiveSource([](const std::string&) -> std::unique_ptr<LiveCamera> {
                     throw std::runtime_error("openni2: no camera is plugged in");
                 }),
                 std::runtime_error);
}

}  // namespace
}  // namespace planemap::camera
