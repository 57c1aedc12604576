// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation.hpp"

#include <stdexcept>

#include "core/validation.hpp"

namespace planemap {

void SegmentationOptions::validate() const {
    FieldErrors errors("segmentation options");
    errors.require(method == "cells" || method == "ransac", "method", method, "\"cells\" or \"ransac\"");
    cells.check("cells.", errors);
    ransac.check("ransac.", errors);
    errors.throw_if_any();
}

std::unique_ptr<Segmenter> make_segmenter(const SegmentationOptions& options) {
    options.validate();
    if (options.method == "ransac") return make_ransac_segmenter(options.ransac, options.seed);
    return make_cell_segmenter(options.cells);
}

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

}  // namespace planemap
