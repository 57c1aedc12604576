// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

namespace planemap::sensor {
namespace {

using namespace std::chrono_literals;
using Status = ReadResult::Status;

/// Ten frames, of which the fourth is broken; after the last it may throw.
class TenFrames : public FrameSource {
  public:
    TenFrames(std::atomic<int>& read, bool is_live, bool throws)
        : read_(read), is_live_(is_live), throws_(throws) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return 10; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        if (read_ == 10 && throws_) throw std::runtime_error("the disk is gone");
        if (read_ == 10) return {};
        frame.utime = ++read_;
        if (frame.utime != 4) return {Status::kFrame, ""};
        frame = {};
        return {Status::kBroken, "it is broken"};
    }
    bool is_live() const override { return is_live_; }
    std::vector<std::string> complaints() const override { return {std::to_string(read_) + " were read"}; }
    std::optional<double> progress() const override { return 0.1 * read_; }

  private:
    CameraInfo camera_;
    std::atomic<int>& read_;
    bool is_live_, throws_;
};

class SourcesAhead : public testing::TestWithParam<int> {
  protected:
    SourceAhead open(bool is_live = false, bool throws = false) {
        return {std::make_unique<TenFrames>(read_, is_live, throws), GetParam(),
                [](const SensorFrame&, int) { return nullptr; }};
    }

    std::atomic<int> read_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Threads, SourcesAhead, testing::Values(1, 2, 4));

TEST_P(SourcesAhead, GiveWhatTheSourceGivesInItsOrder) {
    SourceAhead ahead = open();
    EXPECT_EQ(ahead.progress(), 0.0);
    SensorFrame frame;
    for (int i = 1; i <= 10; ++i) {
        if (i % 3 == 0) {
            EXPECT_EQ(ahead.fetch().frame.utime, i) << "and next() gives the same";
        }
        const ReadResult result = ahead.next(frame);
        EXPECT_EQ(result.status, i == 4 ? Status::kBroken : Status::kFrame);
        EXPECT_EQ(result.message, i == 4 ? "it is broken" : "");
        EXPECT_EQ(frame.utime, i == 4 ? 0 : i);
        EXPECT_DOUBLE_EQ(ahead.progress().value(), 0.1 * i) << "of what was taken";
    }
    for (int i = 0; i < 2; ++i) EXPECT_EQ(ahead.next(frame).status, Status::kEnd);
    EXPECT_EQ(ahead.complaints(), std::vector<std::string>{"10 were read"});
}

TEST_P(SourcesAhead, ThrowWhatTheSourceThrewWhereItDid) {
    SourceAhead ahead = open(false, true);
    SensorFrame frame;
    for (int i = 1; i <= 10; ++i) {
        std::this_thread::sleep_for(1ms);
        EXPECT_NO_THROW(ahead.next(frame)) << i;
    }
    EXPECT_THROW(ahead.next(frame), std::runtime_error);
}

TEST_P(SourcesAhead, OfALiveCameraOneFrameWaits) {
    SourceAhead ahead = open(true);
    SensorFrame frame;
    ahead.next(frame);
    std::this_thread::sleep_for(50ms);
    EXPECT_LE(read_, 2);
}

TEST_P(SourcesAhead, ComplaintsBeforeTheEndReadNothingMore) {
    SourceAhead ahead = open();
    SensorFrame frame;
    ahead.next(frame);
    EXPECT_EQ(ahead.complaints(), std::vector<std::string>{std::to_string(read_) + " were read"});
    EXPECT_LE(read_, 1 + static_cast<int>(frames_ahead(GetParam(), false)));
    EXPECT_EQ(ahead.end(), "");
    EXPECT_EQ(ahead.next(frame).status, Status::kEnd);
}

}  // namespace
}  // namespace planemap::sensor
