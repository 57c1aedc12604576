// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmenter.hpp"

#include <stdexcept>
#include <string>

namespace planemap::segmentation {

void check_input(const DepthImage& depth, const CameraInfo& camera) {
    camera.validate();
    const auto pixels =
        static_cast<std::size_t>(camera.depth.width) * static_cast<std::size_t>(camera.depth.height);
    if (depth.width == camera.depth.width && depth.height == camera.depth.height &&
        depth.pixels.size() == pixels)
        return;
    throw std::invalid_argument(
        "depth image is " + std::to_string(depth.width) + "x" + std::to_string(depth.height) + " with " +
        std::to_string(depth.pixels.size()) + " pixels, must be " + std::to_string(camera.depth.width) + "x" +
        std::to_string(camera.depth.height) + " as camera.depth");
}

void Segmenter::segment(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) {
    label(depth, camera, out);
    tracer_.trace_all(depth, out.labels, camera, out.regions);
}

void Segmenter::label(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) {
    check_input(depth, camera);
    tracer_.recycle(out.regions);
    find(depth, camera, out);
}

}  // namespace planemap::segmentation
