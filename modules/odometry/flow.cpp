// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/flow.hpp"

#include <cmath>
#include <opencv2/video/tracking.hpp>

#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

/// Grey levels around a pixel, between pixels by bilinear interpolation, without their mean.
class Patch {
  public:
    /// False when the patch leaves the image.
    bool cut(const cv::Mat& image, const cv::Point2f& centre) {
        const float left = centre.x - kRadius, top = centre.y - kRadius;
        if (!(left >= 0 && top >= 0)) return false;
        const int u = static_cast<int>(left), v = static_cast<int>(top);
        if (u + kSide >= image.cols || v + kSide >= image.rows) return false;
        const float a = left - static_cast<float>(u), b = top - static_cast<float>(v);
        const float weights[] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
        float sum = 0;
        for (int y = 0; y < kSide; ++y) {
            const unsigned char *upper = image.ptr(v + y) + u, *lower = image.ptr(v + y + 1) + u;
            for (int x = 0; x < kSide; ++x) {
                float& value = values_[y * kSide + x];
                value = weights[0] * upper[x] + weights[1] * upper[x + 1] + weights[2] * lower[x] +
                        weights[3] * lower[x + 1];
                sum += value;
            }
        }
        for (float& value : values_) value -= sum / (kSide * kSide);
        return true;
    }
    float dot(const Patch& other) const {
        float sum = 0;
        for (int i = 0; i < kSide * kSide; ++i) sum += values_[i] * other.values_[i];
        return sum;
    }

  private:
    static constexpr int kRadius = 4, kSide = 2 * kRadius + 1;
    float values_[kSide * kSide];
};

/// True when both images show the same there: their patches correlate, whatever light and contrast. At half
/// size, where a dim texture stands out from the noise. True near the border, where nothing can be said.
bool looks_alike(const FlowPyramid& a, const cv::Point2f& at_a, const FlowPyramid& b,
                 const cv::Point2f& at_b) {
    constexpr float kLeastCorrelation = 0.4f;
    if (a.levels() < 2 || b.levels() < 2) return true;
    Patch here, there;
    if (!here.cut(a.level(1), 0.5f * at_a) || !there.cut(b.level(1), 0.5f * at_b)) return true;
    return here.dot(there) >= kLeastCorrelation * std::sqrt(here.dot(here) * there.dot(there));
}

}  // namespace

FlowPyramid make_flow_pyramid(const GrayImage& gray, int levels, int window_px, bool derivatives) {
    FlowPyramid pyramid;
    pyramid.has_derivatives = derivatives;
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
        found[i] = status[i] && p.x >= 0 && p.y >= 0 && p.x <= width - 1 && p.y <= height - 1 &&
                   looks_alike(from, from_pixels[i], to, p);
    }
    return found;
}

}  // namespace planemap::odometry
