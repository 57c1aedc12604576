// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/flow.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/video/tracking.hpp>
#include <optional>

#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

/// Grey levels around a pixel, between pixels by bilinear interpolation, without their mean. Rows are filled
/// up with zeros to whole vectors.
class Patch {
  public:
    /// False when the patch leaves the image. The image has a border, which may be read.
    bool cut(const cv::Mat& image, const cv::Point2f& centre) {
        const float left = centre.x - kRadius, top = centre.y - kRadius;
        if (!(left >= 0 && top >= 0)) return false;
        const int u = static_cast<int>(left), v = static_cast<int>(top);
        if (u + kSide >= image.cols || v + kSide >= image.rows) return false;
        const float a = left - static_cast<float>(u), b = top - static_cast<float>(v);
        const float weights[] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
        float sums[kRow] = {};
        for (int y = 0; y < kSide; ++y) {
            const unsigned char *upper = image.ptr(v + y) + u, *lower = image.ptr(v + y + 1) + u;
            for (int x = 0; x < kRow; ++x) {
                values_[y][x] = weights[0] * upper[x] + weights[1] * upper[x + 1] + weights[2] * lower[x] +
                                weights[3] * lower[x + 1];
                sums[x] += values_[y][x];
            }
        }
        float sum = 0;
        for (int x = 0; x < kSide; ++x) sum += sums[x];
        const float mean = sum / (kSide * kSide);
        for (auto& row : values_)
            for (int x = 0; x < kRow; ++x) row[x] = x < kSide ? row[x] - mean : 0.0f;
        return true;
    }
    float dot(const Patch& other) const {
        float sums[kRow] = {};
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kRow; ++x) sums[x] += values_[y][x] * other.values_[y][x];
        float sum = 0;
        for (const float part : sums) sum += part;
        return sum;
    }

  private:
    static constexpr int kRadius = 4, kSide = 2 * kRadius + 1, kRow = 12;
    float values_[kSide][kRow];
};

/// Whether both images show the same there: their patches correlate, whatever light and contrast. At half
/// size, where a dim texture stands out from the noise. Nothing near the border, where nothing can be said.
std::optional<bool> look_alike(const FlowPyramid& a, const cv::Point2f& at_a, const FlowPyramid& b,
                               const cv::Point2f& at_b) {
    constexpr float kLeastCorrelation = 0.4f;
    if (a.levels() < 2 || b.levels() < 2) return std::nullopt;
    Patch here, there;
    if (!here.cut(a.level(1), 0.5f * at_a) || !there.cut(b.level(1), 0.5f * at_b)) return std::nullopt;
    return here.dot(there) >= kLeastCorrelation * std::sqrt(here.dot(here) * there.dot(there));
}

/// Derivatives by x and y of every pixel in turn, as OpenCV's flow has them, within a border of zeros. The
/// image lies within a border of its own.
cv::Mat scharr(const cv::Mat& image, int border_px) {
    cv::Mat all(image.rows + 2 * border_px, image.cols + 2 * border_px, CV_16SC2, cv::Scalar::all(0));
    cv::Mat inside = all(cv::Rect(border_px, border_px, image.cols, image.rows));
    const auto step = static_cast<std::ptrdiff_t>(image.step);
    for (int y = 0; y < image.rows; ++y) {
        const unsigned char* const row = image.ptr(y);
        auto* const out = inside.ptr<std::int16_t>(y);
        for (std::ptrdiff_t x = 0; x < image.cols; ++x) {
            const unsigned char *up = row + x - step, *at = row + x, *down = row + x + step;
            out[2 * x] =
                static_cast<std::int16_t>(3 * (up[1] + down[1] - up[-1] - down[-1]) + 10 * (at[1] - at[-1]));
            out[2 * x + 1] =
                static_cast<std::int16_t>(3 * (down[-1] + down[1] - up[-1] - up[1]) + 10 * (down[0] - up[0]));
        }
    }
    return inside;
}

}  // namespace

FlowPyramid make_flow_pyramid(const GrayImage& gray, int levels, int window_px) {
    FlowPyramid pyramid;
    cv::buildOpticalFlowPyramid(as_mat(gray), pyramid.images, {window_px, window_px}, levels - 1, false,
                                cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
    return pyramid;
}

FlowPyramid with_derivatives(const FlowPyramid& pyramid, int window_px) {
    FlowPyramid both;
    both.has_derivatives = true;
    for (int level = 0; level < pyramid.levels(); ++level) {
        both.images.push_back(pyramid.level(level));
        both.images.push_back(scharr(pyramid.level(level), window_px));
    }
    return both;
}

bool FlowResult::is_by_chance() const {
    constexpr double kShare = 0.25, kSigmas = 3;
    const auto tried = static_cast<double>(found.size());
    return alike <= kShare * tried + kSigmas * std::sqrt(kShare * (1 - kShare) * tried);
}

FlowResult track_flow(const FlowPyramid& from, const FlowPyramid& to,
                      const std::vector<cv::Point2f>& from_pixels, std::vector<cv::Point2f>& to_pixels,
                      int window_px, int levels, int iterations) {
    FlowResult result;
    result.found.assign(from_pixels.size(), 0);
    if (from.empty() || to.empty() || from_pixels.empty()) return result;
    std::vector<unsigned char> status;
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, iterations, 0.03);
    cv::calcOpticalFlowPyrLK(from.images, to.images, from_pixels, to_pixels, status, cv::noArray(),
                             {window_px, window_px}, levels - 1, stop, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-4);
    const auto width = static_cast<float>(to.images[0].cols), height = static_cast<float>(to.images[0].rows);
    for (std::size_t i = 0; i < result.found.size(); ++i) {
        const cv::Point2f& p = to_pixels[i];
        if (!(status[i] && p.x >= 0 && p.y >= 0 && p.x <= width - 1 && p.y <= height - 1)) continue;
        const std::optional<bool> alike = look_alike(from, from_pixels[i], to, p);
        result.found[i] = alike.value_or(true);
        result.alike += alike.value_or(false);
    }
    return result;
}

}  // namespace planemap::odometry
