// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/loose_keyframes.hpp"

#include <string>

#include "core/geometry/angle.hpp"
#include "core/geometry/covariance.hpp"
#include "core/stamp.hpp"

namespace planemap::odometry {

void LooseKeyframes::see(const Keyframe& keyframe) {
    constexpr double kLoose_m = 0.1, kLoose_deg = 5;
    if (keyframe.previous_id < 0) return;  // it begins a part of its own, which is said
    const double sigma_m = largest_sigma(keyframe.covariance.topLeftCorner<3, 3>()),
                 sigma_deg = degrees(largest_sigma(keyframe.covariance.bottomRightCorner<3, 3>()));
    if (sigma_m <= kLoose_m && sigma_deg <= kLoose_deg) return;
    ++count_;
    status_.remark("loose",
                   "keyframes that those before hold only to more than 10 cm or 5 deg (one sigma): " +
                       std::to_string(count_) + ", the last at " + seconds_text(keyframe.utime) +
                       ": what follows may be shifted against what was before");
}

}  // namespace planemap::odometry
