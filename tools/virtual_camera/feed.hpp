// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <random>

#include "sensor/source.hpp"
#include "virtual_camera/options.hpp"

namespace planemap::virtual_camera {

/// What the device does at one of its ticks. Images that are lost are empty.
struct Tick {
    std::int64_t due_us = 0;    ///< after the start of the streams, when it arrives
    std::int64_t depth_us = 0;  ///< the device's stamps
    std::int64_t color_us = 0;
    DepthImage depth;  ///< millimetres, as sensed
    RgbImage color;
};

/// An input as a camera takes it: one frame a tick, for ever, with the faults that were ordered. The same
/// order gives the same ticks.
class Feed {
  public:
    /// Throws as open_source().
    explicit Feed(Order order);

    /// The input's, with depth in millimetres and without distortion, of which OpenNI2 has no word.
    const CameraInfo& camera() const { return camera_; }
    const Options& options() const { return order_.options; }
    /// The next tick; false where there is none (--once, or an input without a frame that can be read).
    bool next(Tick& tick);

  private:
    bool read(SensorFrame& frame);

    Order order_;
    std::unique_ptr<FrameSource> source_;
    CameraInfo camera_;
    std::mt19937_64 random_;
    std::int64_t number_ = 0;
    bool is_fresh_ = true;  ///< nothing was read since the source was opened
};

}  // namespace planemap::virtual_camera
