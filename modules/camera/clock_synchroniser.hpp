// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace planemap::camera {

/// Device time to host time without the device's help: the passive synchroniser of Olson, "A passive
/// solution to the sensor synchronization problem", IROS 2010. A stamp arrives some time after it was taken,
/// never before, so the smallest difference of arrival and stamp is the nearest to the truth; it is let grow
/// no faster than the two clocks may drift apart.
/// - Host times only grow, and by at least half of what the device's stamps do.
/// - Behind the shutter they are by the smallest delay of transport, and ahead of that by no more than what
///   max_drift lets grow between two arrivals of that delay.
/// - A device's clock that goes back or jumps, and a host's that does, is a reset: it begins again there.
class ClockSynchroniser {
  public:
    struct Options {
        double max_drift = 2e-4;          ///< of the two clocks, seconds a second
        std::int64_t jump_us = 1000000;   ///< a difference that changes by more is no delay
        int late_arrivals_in_a_row = 30;  ///< so many later than jump_us are none either
    };

    ClockSynchroniser() = default;
    explicit ClockSynchroniser(const Options& options) : options_(options) {}

    /// Host time of a stamp that arrived at `arrival_us`, both microseconds; stamps in order of arrival.
    std::int64_t host_time(std::int64_t device_us, std::int64_t arrival_us);
    /// How often a clock was found to have jumped.
    int resets() const { return resets_; }

  private:
    bool has_jumped(std::int64_t device_us, std::int64_t offset_us);

    Options options_;
    struct Nearest {
        std::int64_t device_us, offset_us;
    };
    std::optional<Nearest> nearest_;  ///< the stamp whose arrival was the least late
    std::int64_t last_device_us_ = 0, last_host_us_ = 0;
    int late_ = 0, resets_ = 0;
};

}  // namespace planemap::camera
