// SPDX-License-Identifier: BSD-3-Clause
// What can go wrong with a stream of frames, as plain values: which images are shown when, and under which
// stamps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace planemap::bench_odometry {

/// One frame that is delivered. Indices count the frames of the undisturbed source, from 0.
struct Shown {
    std::size_t at = 0;              ///< the moment: where the camera is, and the stamps
    std::size_t color = 0;           ///< whose colour image
    std::size_t depth = 0;           ///< whose depth image
    bool keeps_color_stamp = false;  ///< the colour image has its own old stamp; else one of this moment
    std::int64_t later_us = 0;       ///< added to all stamps, microseconds
    bool covered = false;            ///< colour is black and depth has no reading
    double light = 1;                ///< colour values are multiplied by it
    double smear = 0;  ///< colour is averaged along its rows over this share of the image's width
};
/// All frames that are delivered, in order.
using Script = std::vector<Shown>;

/// The undisturbed source.
struct Undisturbed {
    std::size_t frames = 0;
    std::size_t first = 0;  ///< the first frame that is disturbed; at least kFramesBefore
    double rate_hz = 30;
};
/// So many frames before the first disturbed one may be shown again.
inline constexpr std::size_t kFramesBefore = 2;

/// A disturbance by its name. Its script has as many undisturbed frames before the first disturbed one as
/// Undisturbed::first says.
struct Disturbance {
    std::string name;
    std::string what;  ///< one line for --help
    Script (*script)(const Undisturbed& source) = nullptr;
};

/// All there are; the first leaves everything as it is.
const std::vector<Disturbance>& known_disturbances();

/// Every frame as it is.
Script undisturbed(std::size_t frames);

/// Returns after pauses: first the walk, frames 0 to `walk` - 1 as they are; then `cuts` times a pause of
/// `pause_us` and `frames` frames of what follows the walk in the source, from places spread evenly over its
/// `rest` frames. Precondition: rest >= frames, cuts > 0.
Script returns(std::size_t walk, std::size_t rest, int cuts, std::size_t frames, std::int64_t pause_us,
               double rate_hz);

}  // namespace planemap::bench_odometry
