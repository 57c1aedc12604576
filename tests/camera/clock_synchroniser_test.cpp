// SPDX-License-Identifier: BSD-3-Clause
#include "camera/clock_synchroniser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace planemap::camera {
namespace {

constexpr std::int64_t kPeriod = 33333, kHostStart = 1700000000000000;

/// A device whose clock goes `ppm` too fast, seen through delays of 2 ms and up to `jitter_us` more.
class Device {
  public:
    Device(double ppm, std::int64_t jitter_us) : ppm_(ppm), jitter_us_(jitter_us) {}

    struct Sample {
        std::int64_t true_us, device_us, arrival_us;
    };
    Sample next() {
        const std::int64_t true_us = kHostStart + kPeriod * frame_++;
        const double elapsed = static_cast<double>(true_us - kHostStart - began_us_);
        const auto device_us = static_cast<std::int64_t>(std::llround(elapsed * (1 + 1e-6 * ppm_)));
        const std::int64_t delay =
            kLeastDelay + std::uniform_int_distribution<std::int64_t>(0, jitter_us_)(random_);
        return {true_us, device_us + 12345, true_us + delay + extra_us};
    }
    void restart() { began_us_ = kPeriod * frame_; }

    static constexpr std::int64_t kLeastDelay = 2000;
    std::int64_t extra_us = 0;  ///< delay of arrivals from now on

  private:
    double ppm_;
    std::int64_t jitter_us_, frame_ = 0, began_us_ = 0;
    std::mt19937_64 random_{7};
};

TEST(ClockSynchroniser, WithoutJitterIsLateByTheDelayAlone) {
    ClockSynchroniser clock;
    Device device(0, 0);
    for (int i = 0; i < 1000; ++i) {
        const auto s = device.next();
        EXPECT_EQ(clock.host_time(s.device_us, s.arrival_us), s.true_us + Device::kLeastDelay);
    }
    EXPECT_EQ(clock.resets(), 0);
}

TEST(ClockSynchroniser, ErrorIsBoundedUnderJitterAndDrift) {
    for (const double ppm : {-100.0, 0.0, 100.0}) {
        ClockSynchroniser clock;
        Device device(ppm, 20000);
        for (int i = 0; i < 20000; ++i) {  // eleven minutes
            const auto s = device.next();
            const std::int64_t late = clock.host_time(s.device_us, s.arrival_us) - s.true_us;
            if (i < 300) continue;
            EXPECT_GE(late, Device::kLeastDelay - 2000)
                << "drift before an arrival shows it, " << ppm << " ppm";
            EXPECT_LE(late, Device::kLeastDelay + 6000) << "far less than the jitter, " << ppm << " ppm";
        }
        EXPECT_EQ(clock.resets(), 0);
    }
}

TEST(ClockSynchroniser, TimesGrowByAtLeastHalfOfWhatTheStampsDo) {
    ClockSynchroniser clock;
    Device device(50, 60000);  // more jitter than a frame lasts
    std::int64_t last = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto s = device.next();
        const std::int64_t now = clock.host_time(s.device_us, s.arrival_us);
        if (i > 0) {
            EXPECT_GE(now - last, kPeriod / 2 - 5);
        }
        last = now;
    }
}

TEST(ClockSynchroniser, AClockThatBeginsAgainIsNoticed) {
    ClockSynchroniser clock;
    Device device(0, 5000);
    std::int64_t last = 0, late = 0;
    for (int i = 0; i < 600; ++i) {
        if (i == 300) device.restart();
        const auto s = device.next();
        const std::int64_t now = clock.host_time(s.device_us, s.arrival_us);
        EXPECT_GT(now, last);
        last = now;
        late = now - s.true_us;
    }
    EXPECT_EQ(clock.resets(), 1);
    EXPECT_LE(std::abs(late), 8000);
}

TEST(ClockSynchroniser, AHostThatWasStoppedIsNoReset) {
    ClockSynchroniser clock;
    Device device(0, 1000);
    for (int i = 0; i < 300; ++i) {
        device.extra_us = i >= 100 && i < 110 ? 5000000 : 0;
        const auto s = device.next();
        const std::int64_t late = clock.host_time(s.device_us, s.arrival_us) - s.true_us;
        EXPECT_LE(late, 4000) << "frame " << i;
    }
    EXPECT_EQ(clock.resets(), 0);
}

TEST(ClockSynchroniser, AHostClockThatWasSetIsFollowed) {
    for (const std::int64_t step_us : {-3600000000, 3600000000}) {
        ClockSynchroniser clock;
        Device device(0, 1000);
        std::int64_t last = 0;
        for (int i = 0; i < 300; ++i) {
            if (i == 100) device.extra_us = step_us;
            const auto s = device.next();
            const std::int64_t now = clock.host_time(s.device_us, s.arrival_us);
            EXPECT_GT(now, last);
            last = now;
        }
        EXPECT_EQ(clock.resets(), 1);
    }
}

}  // namespace
}  // namespace planemap::camera
