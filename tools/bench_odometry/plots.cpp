// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/geometry/angle.hpp"
#include "results/table.hpp"

namespace planemap::bench_odometry {

using Eigen::Vector2d;
using Eigen::Vector3d;
using results::text;

namespace {

constexpr double kSize_px = 900, kMargin_px = 50, kLegend_px = 240;
constexpr std::int64_t kBreak_us = 1500000;
constexpr const char* kTruthColor = "#999999";
constexpr std::array<const char*, 6> kColors{"#b3142a", "#e08214", "#2166ac",
                                             "#5aae61", "#762a83", "#01665e"};

std::string text_at(double x, double y, const std::string& words, const char* color) {
    return text("<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", x, y, color, words.c_str());
}

std::string line_at(double x0, double y0, double x1, double y1, const char* color) {
    return text("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"3\"/>\n",
                x0, y0, x1, y1, color);
}

/// World points to the page, seen from above.
class TopView {
  public:
    TopView(const Trajectory& truth, const std::vector<Trajectory>& others) {
        const Vector3d up = up_direction(truth);
        const Vector3d axis = std::abs(up.x()) < 0.8 ? Vector3d::UnitX() : Vector3d::UnitY();
        right_ = (axis - axis.dot(up) * up).normalized();
        forward_ = up.cross(right_);
        Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
        const auto include = [&](const Trajectory& trajectory) {
            for (const StampedPose& pose : trajectory) {
                low = low.cwiseMin(level(pose));
                high = high.cwiseMax(level(pose));
            }
        };
        include(truth);
        for (const Trajectory& other : others) include(other);
        if (!(low.x() <= high.x())) return;  // nothing to show
        pixels_per_metre_ = (kSize_px - 2 * kMargin_px) / std::max(0.1, (high - low).maxCoeff());
        middle_ = 0.5 * (low + high);
    }
    Vector2d operator()(const StampedPose& pose) const {
        const Vector2d p = pixels_per_metre_ * (level(pose) - middle_);
        return {kSize_px / 2 + p.x(), kSize_px / 2 - p.y()};
    }
    double pixels_per_metre() const { return pixels_per_metre_; }

  private:
    Vector2d level(const StampedPose& pose) const {
        const Vector3d p = pose.world_from_camera.translation();
        return {right_.dot(p), forward_.dot(p)};
    }
    Vector3d right_, forward_;
    Vector2d middle_ = Vector2d::Zero();
    double pixels_per_metre_ = 1;
};

std::string polyline(const Trajectory& trajectory, const TopView& view, const char* color, double width) {
    std::string d;
    const StampedPose* before = nullptr;
    for (const StampedPose& pose : trajectory) {
        const Vector2d p = view(pose);
        d += before == nullptr || pose.utime - before->utime > kBreak_us ? 'M' : 'L';
        d += text("%.1f,%.1f", p.x(), p.y());
        before = &pose;
    }
    return "<path d=\"" + d +
           text("\" fill=\"none\" stroke=\"%s\" stroke-width=\"%.1f\" stroke-linejoin=\"round\"/>\n", color,
                width);
}

/// 1, 2 or 5 times a power of ten metres: about a fifth of the page.
std::string scale_bar(double pixels_per_metre) {
    const double wanted = kSize_px / 5 / pixels_per_metre;
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    const double metres = power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1);
    constexpr double kY = kSize_px - 15;
    return line_at(kMargin_px, kY, kMargin_px + metres * pixels_per_metre, kY, "#000000") +
           text_at(kMargin_px + metres * pixels_per_metre + 8, kY + 5, text("%g m", metres), "#000000");
}

/// The truth from the first to the last moment that any of the others is of.
Trajectory within(const Trajectory& truth, const std::vector<Trajectory>& others) {
    std::int64_t first = std::numeric_limits<std::int64_t>::max(),
                 last = std::numeric_limits<std::int64_t>::min();
    for (const Trajectory& other : others) {
        if (other.empty()) continue;
        first = std::min(first, other.front().utime);
        last = std::max(last, other.back().utime);
    }
    Trajectory result;
    for (const StampedPose& pose : truth)
        if (pose.utime >= first && pose.utime <= last) result.push_back(pose);
    return result;
}

}  // namespace

Vector3d up_direction(const Trajectory& trajectory) {
    Vector3d up = Vector3d::Zero();
    for (const StampedPose& pose : trajectory) up -= pose.world_from_camera.linear().col(1);
    if (up.norm() < 1e-9) return Vector3d::UnitZ();
    up.normalize();
    Eigen::Index axis = 0;
    if (up.cwiseAbs().maxCoeff(&axis) < std::cos(radians(35))) return up;
    return std::copysign(1.0, up[axis]) * Vector3d::Unit(axis);
}

std::string plot_svg(const std::string& title, const Trajectory& whole_truth, const std::vector<Row>& rows) {
    std::vector<const Row*> shown;
    std::vector<Trajectory> aligned;
    for (const Row& row : rows) {
        if (!row.evaluation || !row.evaluation->ate) continue;
        shown.push_back(&row);
        aligned.push_back(row.run.trajectory);
        for (StampedPose& pose : aligned.back())
            pose.world_from_camera = row.evaluation->ate->truth_from_estimate * pose.world_from_camera;
    }
    const Trajectory truth = within(whole_truth, aligned);
    const TopView view(truth, aligned);
    std::string svg = text(
                          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
                          "font-family=\"sans-serif\" font-size=\"15\">\n",
                          kSize_px + kLegend_px, kSize_px) +
                      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" +
                      polyline(truth, view, kTruthColor, 5);
    std::string legend = text_at(kSize_px, kMargin_px, title + ", from above", "#000000") +
                         line_at(kSize_px, kMargin_px + 25, kSize_px + 25, kMargin_px + 25, kTruthColor) +
                         text_at(kSize_px + 32, kMargin_px + 30, "truth", "#000000");
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const char* color = kColors[i % kColors.size()];
        const double y = kMargin_px + 50 + 25 * static_cast<double>(i);
        svg += polyline(aligned[i], view, color, 1.5);
        legend += line_at(kSize_px, y, kSize_px + 25, y, color) +
                  text_at(kSize_px + 32, y + 5,
                          shown[i]->method + text(", %.1f cm", 100 * shown[i]->evaluation->ate->metres.rmse),
                          "#000000");
    }
    return svg + legend + scale_bar(view.pixels_per_metre()) + "</svg>\n";
}

}  // namespace planemap::bench_odometry
