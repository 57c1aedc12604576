// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/dense.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr int kFinest = 3, kCoarsest = 4;
constexpr float kMinGradient = 2;     // grey levels a pixel
constexpr double kLumaSigma = 8;      // grey levels
constexpr double kIndependent = 0.2;  // share of the pixels that count as independent

struct Sample {
    float residual = 0;
    Twist jacobian = Twist::Zero();
};

}  // namespace

DenseReference make_dense_reference(const FlowPyramid& pyramid, const DepthImage& depth,
                                    const CameraInfo& info) {
    DenseReference reference;
    const PinholeCamera& camera = info.color;
    for (int level = std::min<int>(kCoarsest, static_cast<int>(pyramid.images.size()) - 1); level >= kFinest;
         --level) {
        const cv::Mat& image = pyramid.images[static_cast<std::size_t>(level)];
        DenseLevel dense;
        dense.level = level;
        for (int y = 1; y + 1 < image.rows; ++y) {
            const unsigned char *above = image.ptr(y - 1), *row = image.ptr(y), *below = image.ptr(y + 1);
            for (int x = 1; x + 1 < image.cols; ++x) {
                const float gx = 0.5f * static_cast<float>(row[x + 1] - row[x - 1]);
                const float gy = 0.5f * static_cast<float>(below[x] - above[x]);
                if (std::max(std::abs(gx), std::abs(gy)) < kMinGradient) continue;
                const int u = x << level, v = y << level;
                if (!depth.contains(u, v) || !is_valid_depth(depth(u, v))) continue;
                dense.points.push_back(camera.unproject(u, v, info.metres(depth(u, v))).cast<float>());
                dense.values.push_back(row[x]);
            }
        }
        reference.levels.push_back(std::move(dense));
    }
    return reference;
}

QuadraticTerm photometric_term(const DenseLevel& reference, const FlowPyramid& pyramid,
                               const PinholeCamera& camera, const Pose& camera_from_reference) {
    const cv::Mat& image = pyramid.images[static_cast<std::size_t>(reference.level)];
    const float scale = 1.0f / static_cast<float>(1 << reference.level);
    const float fx = static_cast<float>(camera.fx) * scale, fy = static_cast<float>(camera.fy) * scale;
    const float cx = static_cast<float>(camera.cx) * scale, cy = static_cast<float>(camera.cy) * scale;
    const Eigen::Isometry3f pose = camera_from_reference.cast<float>();
    std::vector<Sample> samples;
    samples.reserve(reference.points.size());
    double sum = 0;
    for (std::size_t i = 0; i < reference.points.size(); ++i) {
        const Eigen::Vector3f p = pose * reference.points[i];
        if (!(p.z() > 0.05f)) continue;
        const float x = p.x() / p.z(), y = p.y() / p.z();
        const float u = fx * x + cx, v = fy * y + cy;
        if (!(u >= 1 && v >= 1 && u < static_cast<float>(image.cols - 2) &&
              v < static_cast<float>(image.rows - 2)))
            continue;
        const int column = static_cast<int>(u), line = static_cast<int>(v);
        const float a = u - static_cast<float>(column), b = v - static_cast<float>(line);
        const unsigned char *top = image.ptr(line) + column, *bottom = image.ptr(line + 1) + column;
        const float upper = static_cast<float>(top[0]) * (1 - a) + static_cast<float>(top[1]) * a;
        const float lower = static_cast<float>(bottom[0]) * (1 - a) + static_cast<float>(bottom[1]) * a;
        const float gx = fx * (static_cast<float>(top[1] - top[0]) * (1 - b) +
                               static_cast<float>(bottom[1] - bottom[0]) * b);
        const float gy = fy * (lower - upper);
        Sample sample;
        sample.residual = upper * (1 - b) + lower * b - reference.values[i];
        sample.jacobian << gx / p.z(), gy / p.z(), -(gx * x + gy * y) / p.z(), -gx * x * y - gy * (1 + y * y),
            gx * (1 + x * x) + gy * x * y, gy * x - gx * y;
        sum += sample.residual;
        samples.push_back(sample);
    }
    QuadraticTerm term;
    if (samples.empty()) return term;
    const double offset = sum / static_cast<double>(samples.size());
    for (const Sample& sample : samples) {
        const double r = (sample.residual - offset) / kLumaSigma;
        const double weight = kIndependent / (1 + r * r) / (kLumaSigma * kLumaSigma);
        term.information.selfadjointView<Eigen::Upper>().rankUpdate(sample.jacobian, weight);
        term.gradient += (weight * kLumaSigma * r) * sample.jacobian;
    }
    term.information.triangularView<Eigen::StrictlyLower>() = term.information.transpose();
    return term;
}

}  // namespace planemap::odometry
