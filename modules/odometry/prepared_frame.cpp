// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/prepared_frame.hpp"

#include <stdexcept>

namespace planemap::odometry {

void check(const OdometryFrame& frame) {
    if (!frame.depth || !frame.camera)
        throw std::invalid_argument("OdometryFrame: depth and camera are needed");
    const PinholeCamera& camera = frame.camera->color;
    const auto fits = [&](const auto& image) {
        return image.width == camera.width && image.height == camera.height &&
               image.pixels.size() ==
                   static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    };
    if (!fits(*frame.depth))
        throw std::invalid_argument("OdometryFrame: depth is not of the colour camera's size; register it");
    if (frame.gray && !fits(*frame.gray))
        throw std::invalid_argument("OdometryFrame: gray is not of the colour camera's size");
}

PreparedFrame prepare(const OdometryOptions& options, const OdometryFrame& frame, double readout_s) {
    PreparedFrame prepared;
    prepared.utime = frame.utime;
    prepared.gray = frame.gray;
    prepared.depth = frame.depth;
    prepared.camera = frame.camera;
    prepared.readout_s = readout_s;
    if (frame.gray) {
        if (frame.color_utime != 0) prepared.color_offset_s = seconds(frame.color_utime - frame.utime);
        prepared.pyramid = make_flow_pyramid(*frame.gray, options.flow_wide_levels, options.flow_window_px);
    }
    prepared.samples =
        sample_depth(*frame.depth, frame.camera->color, *frame.camera, options.surface_stride_px);
    for (const PlanarRegion& region : frame.regions)
        if (is_valid(region)) prepared.regions.push_back(region);
    return prepared;
}

}  // namespace planemap::odometry
