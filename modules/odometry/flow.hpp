// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/image.hpp"

namespace planemap {

/// The image pyramid that tracking starts from or ends in.
struct FlowPyramid {
    std::vector<cv::Mat> images;  ///< OpenCV's layout: levels, with derivatives between them if asked for

    bool empty() const { return images.empty(); }
};

/// Levels of an image with borders for windows of window_px. With `derivatives`, tracking that starts from it
/// is faster; copies the image.
FlowPyramid make_flow_pyramid(const GrayImage& gray, int levels, int window_px, bool derivatives);

/// Pyramidal Lucas-Kanade. `to_pixels` holds the first guesses and becomes the result; the return says which
/// points were found inside the image.
std::vector<char> track_flow(const FlowPyramid& from, const FlowPyramid& to,
                             const std::vector<cv::Point2f>& from_pixels, std::vector<cv::Point2f>& to_pixels,
                             int window_px, int levels, int iterations);

}  // namespace planemap
