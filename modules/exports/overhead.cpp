// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "exports/exports.hpp"
#include "exports/parts.hpp"
#include "exports/svg.hpp"

namespace planemap::exports {

namespace {

constexpr double kNumberedArea_m2 = 0.15;  ///< smaller planes are drawn without their number
constexpr double kLevel = 0.35;            ///< of the normal along up: more is a surface, less is upright

/// What a plane is filled with, or an upright one drawn with: a colour a label.
Rgb label_color(PlaneLabel label) {
    switch (label) {
        case PlaneLabel::kFloor:
            return {236, 219, 180};
        case PlaneLabel::kCeiling:
            return {203, 184, 232};
        case PlaneLabel::kWall:
            return {46, 72, 101};
        case PlaneLabel::kHorizontal:
            return {104, 184, 138};
        case PlaneLabel::kVertical:
            return {96, 150, 204};
        case PlaneLabel::kOther:
            return {224, 123, 77};
        case PlaneLabel::kUnknown:
            break;
    }
    return {170, 170, 170};
}

/// Puts numbers on a page so that they do not cover each other.
class Numbers {
  public:
    std::string place(const MapPlane& plane, const Eigen::Vector2d& wanted) {
        const std::string number = std::to_string(plane.id);
        const double radius = 6.0 + 3.0 * static_cast<double>(number.size());
        Eigen::Vector2d at = wanted;
        for (int step = 0; step < 60 && covers_another(at, radius); ++step) {
            const double angle = 2.4 * step, away = 5.0 * std::sqrt(step + 1.0);  // a sunflower's spiral
            at = wanted + away * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        }
        placed_.push_back({at, radius});
        std::string svg;
        if ((at - wanted).norm() > radius) {
            svg +=
                "<path d=\"" + move_to(wanted) + line_to(at) + "\" stroke=\"#555\" stroke-width=\"0.7\"/>\n";
        }
        return svg + "<circle cx=\"" + pixels(at.x()) + "\" cy=\"" + pixels(at.y()) + "\" r=\"" +
               pixels(radius) + "\" fill=\"white\" fill-opacity=\"0.8\" stroke=\"" +
               css(label_color(plane.label), 0.8) + "\" stroke-width=\"1.2\"/><text x=\"" + pixels(at.x()) +
               "\" y=\"" + pixels(at.y() + 4.5) + "\" text-anchor=\"middle\">" + number + "</text>\n";
    }

  private:
    bool covers_another(const Eigen::Vector2d& at, double radius) const {
        return std::any_of(placed_.begin(), placed_.end(), [&](const auto& other) {
            return (other.first - at).norm() < radius + other.second;
        });
    }
    std::vector<std::pair<Eigen::Vector2d, double>> placed_;
};

std::string drawn_footprint(const MapPlane& plane, const Eigen::Matrix3d& level, const Fit& fit) {
    std::string d;
    for (const auto& [from, to] : footprint(plane, level)) d += move_to(fit(from)) + line_to(fit(to));
    return d;
}

/// Dashed: the inferred part of a plane, which is the outline of this one.
std::string inferred_part(const MapPlane& plane, const Eigen::Matrix3d& level, const Fit& fit) {
    const double upward = level.row(2).dot(plane.normal.cast<double>());
    const std::string color = css(label_color(plane.label), upward > kLevel ? 0.6 : 1);
    if (upward < -kLevel) return {};
    if (upward <= kLevel) {
        return "<path d=\"" + drawn_footprint(plane, level, fit) + "\" fill=\"none\" stroke=\"" + color +
               "\" stroke-width=\"2\" stroke-dasharray=\"5 4\"/>\n";
    }
    const auto project = [&](const Eigen::Vector3d& p) { return fit((level * p).head<2>()); };
    return "<path d=\"" + path(world_rings(plane), project) + "\" fill-rule=\"evenodd\" fill=\"" +
           css(label_color(plane.label)) + "\" fill-opacity=\"0.3\" stroke=\"" + color +
           "\" stroke-width=\"0.8\" stroke-dasharray=\"5 4\"/>\n";
}

/// What became of the planes of a map in the overhead drawing.
struct Shown {
    const MapPlane* plane;
    bool drawn, numbered;
};

/// Every plane of the map by its label, with the label's colour; beside the drawing.
std::string legend(const std::vector<Shown>& planes, std::size_t all, bool has_inferred) {
    const double x = kPageWidth_px - kLegendWidth_px + 24;
    double y = kTitleHeight_px + 30;
    std::string svg;
    const auto line = [&](const std::string& mark, const std::string& what, const char* attributes = "") {
        svg += mark + words({x + 26, y + 4.5}, what, attributes);
        y += 22;
    };
    std::size_t hidden_count = 0, small_count = 0;
    for (const PlaneLabel label :
         {PlaneLabel::kFloor, PlaneLabel::kCeiling, PlaneLabel::kWall, PlaneLabel::kHorizontal,
          PlaneLabel::kVertical, PlaneLabel::kOther, PlaneLabel::kUnknown}) {
        std::size_t count = 0, hidden = 0;
        for (const Shown& shown : planes) {
            if (shown.plane->label != label) continue;
            ++count;
            hidden += shown.drawn ? 0 : 1;
            small_count += shown.drawn && !shown.numbered ? 1 : 0;
        }
        hidden_count += hidden;
        if (count == 0) continue;
        line("<rect x=\"" + pixels(x) + "\" y=\"" + pixels(y - 7) + "\" width=\"18\" height=\"14\" fill=\"" +
                 css(label_color(label)) + "\" stroke=\"#555\" stroke-width=\"0.7\"/>",
             std::string(label_name(label)) + " (" + std::to_string(count) + ")" +
                 (hidden == 0       ? ""
                  : hidden == count ? ", not drawn"
                                    : ", " + std::to_string(hidden) + " not drawn"));
    }
    line("<path d=\"" + move_to({x, y}) + "h18\" stroke=\"" + css(kTrajectoryColor) +
             "\" stroke-width=\"2\"/>",
         "trajectory, from the green dot");
    if (has_inferred) {
        line("<path d=\"" + move_to({x, y}) +
                 "h18\" stroke=\"#555\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"/>",
             "inferred, behind things");
    }
    const char* small = "font-size=\"11\" fill=\"#555\"";
    if (hidden_count > 0) line("", count_of(hidden_count, "plane") + " not drawn: seen from below", small);
    if (small_count > 0)
        line("", std::to_string(small_count) + " without number: under " + fixed(kNumberedArea_m2, 2) + " m²",
             small);
    if (all > planes.size()) line("", std::to_string(all - planes.size()) + " without outline", small);
    return svg;
}

}  // namespace

std::string overhead_svg(const PlaneMap& map, const Trajectory& trajectory) {
    const Eigen::Matrix3d level = level_from_world(map, up_of(map, trajectory));
    const auto height = [&](const MapPlane* plane) { return level.row(2).dot(plane->center.cast<double>()); };
    std::vector<const MapPlane*> surfaces, walls;
    std::vector<Shown> shown;
    std::vector<Eigen::Vector2d> extent;
    for (const MapPlane* plane : drawable_planes(map)) {
        const double upward = level.row(2).dot(plane->normal.cast<double>());
        const bool drawn = upward >= -kLevel;
        shown.push_back({plane, drawn, drawn && plane->area >= kNumberedArea_m2});
        if (!drawn) continue;
        (upward > kLevel ? surfaces : walls).push_back(plane);
        for (const auto& ring : world_rings(*plane))
            for (const auto& p : ring) extent.push_back((level * p).head<2>());
    }
    for (const StampedPose& pose : trajectory)
        extent.push_back((level * pose.world_from_camera.translation()).head<2>());
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [&](auto* a, auto* b) { return height(a) < height(b); });

    const std::vector<MapPlane> inferred = inferred_planes(map);
    for (const MapPlane& plane : inferred)
        for (const auto& ring : world_rings(plane))
            for (const auto& p : ring) extent.push_back((level * p).head<2>());
    const Fit fit(extent, drawing_area(true));
    const auto project = [&](const Eigen::Vector3d& p) { return fit((level * p).head<2>()); };
    std::string shapes, labels;
    Numbers numbers;
    for (const MapPlane* plane : surfaces) {
        const Rgb color = label_color(plane->label);
        shapes += "<path d=\"" + path(world_rings(*plane), project) + "\" fill-rule=\"evenodd\" fill=\"" +
                  css(color) + "\" fill-opacity=\"0.8\" stroke=\"" + css(color, 0.6) +
                  "\" stroke-width=\"0.8\">" + tooltip(*plane) + "</path>\n";
    }
    for (const MapPlane& plane : inferred) shapes += inferred_part(plane, level, fit);
    for (const MapPlane* plane : walls) {
        const std::string d = drawn_footprint(*plane, level, fit);
        shapes += "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + css(label_color(plane->label)) +
                  "\" stroke-width=\"4\">" + tooltip(*plane) + "</path>\n";
    }
    for (const auto* group : {&walls, &surfaces}) {
        for (const MapPlane* plane : *group) {
            if (plane->area < kNumberedArea_m2) continue;
            labels += numbers.place(*plane, project(plane->center.cast<double>()));
        }
    }
    return page(count_of(map.planes.size(), "plane") + " from above",
                "walls and other upright planes as lines; " + up_text(map),
                shapes + trajectory_line(trajectory, project) + labels + scale_bar(fit.scale()) +
                    legend(shown, map.planes.size(), !inferred.empty()));
}

}  // namespace planemap::exports
