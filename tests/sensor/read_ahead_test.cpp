// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/read_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

namespace planemap::sensor {
namespace {

using namespace std::chrono_literals;
using Status = ReadResult::Status;

/// Three frames; before the second it waits until it is let go, after the third it may throw.
class SlowSource : public FrameSource {
  public:
    explicit SlowSource(bool throws = false) : throws_(throws) {}
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return 3; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        while (read_ == 1 && !go_) std::this_thread::sleep_for(1ms);
        if (read_ == 3 && throws_) throw std::runtime_error("the camera is gone");
        if (read_ == 3) return {};
        frame.utime = ++read_;
        return {Status::kFrame, ""};
    }
    void go() { go_ = true; }
    int read() const { return read_; }

  private:
    CameraInfo camera_;
    bool throws_;
    std::atomic<bool> go_ = false;
    std::atomic<int> read_ = 0;
};

TEST(ReadAhead, GivesAllInOrderAndDoesNotWaitForTheSource) {
    const auto source = std::make_shared<SlowSource>();
    ReadAhead ahead(source);
    EXPECT_EQ(ahead.take(10s)->frame.utime, 1);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(ahead.take(5ms));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
    source->go();
    EXPECT_EQ(ahead.take(10s)->frame.utime, 2);
    EXPECT_EQ(ahead.take(10s)->frame.utime, 3);
    EXPECT_EQ(ahead.take(10s)->result.status, Status::kEnd);
    EXPECT_FALSE(ahead.take(10s)) << "and does not wait for it";
}

TEST(ReadAhead, ReadsOneFrameAheadAndNoMore) {
    const auto source = std::make_shared<SlowSource>();
    source->go();
    ReadAhead ahead(source);
    std::this_thread::sleep_for(100ms);
    EXPECT_LE(source->read(), 2) << "one that waits to be taken, and one in hand";
}

TEST(ReadAhead, ThrowsWhatTheSourceThrew) {
    const auto source = std::make_shared<SlowSource>(true);
    source->go();
    ReadAhead ahead(source);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(ahead.take(10s));
    EXPECT_THROW(ahead.take(10s), std::runtime_error);
}

TEST(ReadAhead, ASourceThatBlocksDoesNotHoldTheEnd) {
    const auto source = std::make_shared<SlowSource>();
    const auto start = std::chrono::steady_clock::now();
    { ReadAhead ahead(source); }
    EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
    source->go();
}

}  // namespace
}  // namespace planemap::sensor
