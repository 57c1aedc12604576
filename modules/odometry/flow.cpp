// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/flow.hpp"

#include <opencv2/video/tracking.hpp>

#include "odometry/features.hpp"

namespace planemap {

FlowPyramid make_flow_pyramid(const GrayImage& gray, int levels, int window_px, bool derivatives) {
    FlowPyramid pyramid;
    cv::buildOpticalFlowPyramid(as_mat(gray), pyramid.images, {window_px, window_px}, levels - 1, derivatives,
                                cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
    return pyramid;
}

std::vector<char> track_flow(const FlowPyramid& from, const FlowPyramid& to,
                             const std::vector<cv::Point2f>& from_pixels, std::vector<cv::Point2f>& to_pixels,
                             int window_px, int levels, int iterations) {
    std::vector<char> found(from_pixels.size(), 0);
    if (from.empty() || to.empty() || from_pixels.empty()) return found;
    std::vector<unsigned char> status;
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, iterations, 0.03);
    cv::calcOpticalFlowPyrLK(from.images, to.images, from_pixels, to_pixels, status, cv::noArray(),
                             {window_px, window_px}, levels - 1, stop, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-4);
    const auto width = static_cast<float>(to.images[0].cols), height = static_cast<float>(to.images[0].rows);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const cv::Point2f& p = to_pixels[i];
        found[i] = status[i] && p.x >= 0 && p.y >= 0 && p.x <= width - 1 && p.y <= height - 1;
    }
    return found;
}

}  // namespace planemap
