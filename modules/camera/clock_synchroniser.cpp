// SPDX-License-Identifier: BSD-3-Clause
#include "camera/clock_synchroniser.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace planemap::camera {

bool ClockSynchroniser::has_jumped(std::int64_t device_us, std::int64_t offset_us) {
    if (device_us < last_device_us_) return true;
    const std::int64_t later_us = offset_us - nearest_->offset_us;
    if (later_us < -options_.jump_us) return true;
    // A process that was stopped, or a cable that stuttered, makes a few arrivals late, and no more.
    late_ = later_us > options_.jump_us ? late_ + 1 : 0;
    return late_ >= options_.late_arrivals_in_a_row;
}

std::int64_t ClockSynchroniser::host_time(std::int64_t device_us, std::int64_t arrival_us) {
    const std::int64_t offset_us = arrival_us - device_us;
    const bool first = !nearest_;
    const bool jumped = !first && has_jumped(device_us, offset_us);
    if (jumped) {
        ++resets_;
        late_ = 0;
        nearest_.reset();
    }
    const auto drift_us = [&] {
        return std::llround(options_.max_drift * static_cast<double>(device_us - nearest_->device_us));
    };
    if (!nearest_ || offset_us <= nearest_->offset_us + drift_us()) nearest_ = Nearest{device_us, offset_us};
    std::int64_t host_us = device_us + nearest_->offset_us;
    if (!first) {
        const std::int64_t step_us = jumped ? 0 : (device_us - last_device_us_) / 2;
        host_us = std::max(host_us, last_host_us_ + std::max<std::int64_t>(step_us, 1));
    }
    last_device_us_ = device_us;
    return last_host_us_ = host_us;
}

}  // namespace planemap::camera
