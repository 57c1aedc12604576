// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/readout.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr double kLongest = 0.05;  // seconds; no camera of 20 frames a second or more takes longer

}  // namespace

double Readout::seconds() const {
    return std::clamp(moment_ / information_, -kLongest, kLongest);
}

void Readout::learn(double used_s, const AlignmentResult& result) {
    if (!std::isfinite(result.readout_information) || !std::isfinite(result.readout_gradient)) return;
    information_ += result.readout_information;
    moment_ += result.readout_information * used_s - result.readout_gradient;
}

}  // namespace planemap::odometry
