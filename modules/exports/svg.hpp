// SPDX-License-Identifier: BSD-3-Clause
// What the two drawings share: a page of SVG, what is on it, and how metres come to pixels.
#pragma once

#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

using Polygon3 = std::vector<std::vector<Eigen::Vector3d>>;  ///< rings in the world frame

constexpr double kPageWidth_px = 1200, kPageHeight_px = 800, kMargin_px = 40;
constexpr double kTitleHeight_px = 44, kFootHeight_px = 50, kLegendWidth_px = 260;

/// A length or coordinate on the page, to a tenth of a pixel.
std::string pixels(double value);

/// Commands of a path.
std::string move_to(const Eigen::Vector2d& p);
std::string line_to(const Eigen::Vector2d& p);

/// A colour as CSS writes it; a shade below 1 is darker.
std::string css(const Rgb& color, double shade = 1);

/// What a viewer shows when the mouse rests on the plane.
std::string tooltip(const MapPlane& plane);

/// A line of text.
std::string words(const Eigen::Vector2d& at, const std::string& what, const char* attributes = "");

/// The whole file: title, subtitle and what is drawn.
std::string page(const std::string& title, const std::string& subtitle, const std::string& body);

/// "1 plane", "2 planes".
std::string count_of(std::size_t count, const std::string& what);

/// Where up comes from, in words.
std::string up_text(const PlaneMap& map);

/// 1, 2 or 5 times a power of ten, the largest that is not over `most`.
double round_length(double most);

/// "0.5 m".
std::string metres(double length);

/// A bar in the foot of the page, about a sixth of its width.
std::string scale_bar(double pixels_per_metre);

/// Rings as the commands of one path; project() maps points of the world to the page.
template <typename Project>
std::string path(const Polygon3& rings, const Project& project) {
    std::string d;
    for (const auto& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i)
            d += i == 0 ? move_to(project(ring[i])) : line_to(project(ring[i]));
        d += "Z";
    }
    return d;
}

/// The way of the camera, from a green dot on; nothing without poses.
template <typename Project>
std::string trajectory_line(const Trajectory& trajectory, const Project& project) {
    if (trajectory.empty()) return {};
    std::string d;
    for (const StampedPose& pose : trajectory) {
        const Eigen::Vector2d p = project(pose.world_from_camera.translation());
        d += d.empty() ? move_to(p) : line_to(p);
    }
    const auto dot = [&](const StampedPose& pose, const std::string& color) {
        const Eigen::Vector2d p = project(pose.world_from_camera.translation());
        return "<circle cx=\"" + pixels(p.x()) + "\" cy=\"" + pixels(p.y()) + "\" r=\"5\" fill=\"" + color +
               "\" stroke=\"white\"/>\n";
    };
    return "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + css(kTrajectoryColor) +
           "\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n" + dot(trajectory.front(), "rgb(26,127,55)") +
           dot(trajectory.back(), css(kTrajectoryColor));
}

/// A part of the page.
struct Area {
    Eigen::Vector2d low, high;
};
/// Between title and foot; beside the legend or all across.
Area drawing_area(bool beside_legend);

/// Scales and centres points in an area of the page; y of the input points up the page.
class Fit {
  public:
    Fit(const std::vector<Eigen::Vector2d>& points, const Area& area);
    double scale() const { return scale_; }  ///< pixels per metre
    Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
        const Eigen::Vector2d q = scale_ * (p - middle_);
        return {centre_.x() + q.x(), centre_.y() - q.y()};
    }

  private:
    double scale_ = 1;
    Eigen::Vector2d centre_, middle_;
};

}  // namespace planemap::exports
