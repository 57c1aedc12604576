// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/image.hpp"

namespace planemap::odometry {

/// The image pyramid that tracking starts from or ends in.
struct FlowPyramid {
    std::vector<cv::Mat> images;  ///< OpenCV's layout: levels, with derivatives between them if it has any
    bool has_derivatives = false;

    bool empty() const { return images.empty(); }
    /// The image at a level that exists; 0 is the full one.
    const cv::Mat& level(int i) const {
        return images[static_cast<std::size_t>(has_derivatives ? 2 * i : i)];
    }
    int levels() const { return static_cast<int>(images.size()) / (has_derivatives ? 2 : 1); }
};

/// Levels of an image with borders for windows of window_px; copies the image.
FlowPyramid make_flow_pyramid(const GrayImage& gray, int levels, int window_px);

/// The same levels, shared, with their derivatives: flow that starts from them is faster. Precondition: the
/// pyramid was made for the same window and has no derivatives.
FlowPyramid with_derivatives(const FlowPyramid& pyramid, int window_px);

/// What flow found.
struct FlowResult {
    std::vector<char> found;  ///< one per point: inside the image, where both images look alike
    int alike = 0;            ///< points where patches of both images were held against each other and are

    /// Whether no more points look alike than in two images that show nothing but noise. There 9 to 25 % do,
    /// since flow goes to where they do; in images that show something it is 67 % and more.
    bool is_by_chance() const;
};

/// Pyramidal Lucas-Kanade. `to_pixels` holds the first guesses and becomes the result. Flow finds something
/// near its guess in a dark image too, and would confirm any guess: hence what FlowResult says.
FlowResult track_flow(const FlowPyramid& from, const FlowPyramid& to,
                      const std::vector<cv::Point2f>& from_pixels, std::vector<cv::Point2f>& to_pixels,
                      int window_px, int levels, int iterations);

}  // namespace planemap::odometry
