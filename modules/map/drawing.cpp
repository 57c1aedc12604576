// SPDX-License-Identifier: BSD-3-Clause
// The pictures of export.hpp.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "map/export.hpp"
#include "map/export_parts.hpp"

namespace planemap::map {

namespace {

using Polygon3 = std::vector<std::vector<Eigen::Vector3d>>;  ///< rings in the world frame

constexpr double kPageWidth_px = 1200, kPageHeight_px = 800, kMargin_px = 40;
constexpr double kTitleHeight_px = 44, kFootHeight_px = 50, kLegendWidth_px = 260;
constexpr double kNumberedArea_m2 = 0.15;  ///< smaller planes are drawn without their number

std::string text(double value) {
    return fixed(value, 1);
}

std::string move_to(const Eigen::Vector2d& p) {
    return std::string("M") + text(p.x()) + "," + text(p.y());
}

std::string line_to(const Eigen::Vector2d& p) {
    return std::string("L") + text(p.x()) + "," + text(p.y());
}

std::string css(const Rgb& color, double shade = 1) {
    const auto channel = [&](std::uint8_t c) {
        return std::to_string(std::clamp(std::lround(shade * c), 0l, 255l));
    };
    return std::string("rgb(") + channel(color.r) + "," + channel(color.g) + "," + channel(color.b) + ")";
}

/// What a viewer shows when the mouse rests on the plane.
std::string tooltip(const MapPlane& plane) {
    return "<title>plane " + std::to_string(plane.id) + ", " + label_name(plane.label) + ", " +
           fixed(static_cast<double>(plane.area), 2) + " m²</title>";
}

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
        return "<circle cx=\"" + text(p.x()) + "\" cy=\"" + text(p.y()) + "\" r=\"5\" fill=\"" + color +
               "\" stroke=\"white\"/>\n";
    };
    return "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + css(kTrajectoryColor) +
           "\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n" + dot(trajectory.front(), "rgb(26,127,55)") +
           dot(trajectory.back(), css(kTrajectoryColor));
}

std::string words(const Eigen::Vector2d& at, const std::string& what, const char* attributes = "") {
    return "<text x=\"" + text(at.x()) + "\" y=\"" + text(at.y()) + "\" " + attributes + ">" + what +
           "</text>\n";
}

std::string page(const std::string& title, const std::string& subtitle, const std::string& body) {
    const std::string size = text(kPageWidth_px) + "\" height=\"" + text(kPageHeight_px);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
           text(kPageWidth_px) + " " + text(kPageHeight_px) +
           "\" font-family=\"sans-serif\" font-size=\"13\">\n<title>" + title + "</title>\n<rect width=\"" +
           size + "\" fill=\"white\"/>\n" + body + words({16, 24}, title, "font-size=\"17\"") +
           words({16, 41}, subtitle, "fill=\"#555\"") + "</svg>\n";
}

std::string count_of(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Where up comes from.
std::string up_text(const PlaneMap& map) {
    return map.up.isZero() ? "up: as the camera was held, the planes do not tell it"
                           : "up: as the planes tell it";
}

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
        return svg + "<circle cx=\"" + text(at.x()) + "\" cy=\"" + text(at.y()) + "\" r=\"" + text(radius) +
               "\" fill=\"white\" fill-opacity=\"0.8\" stroke=\"" + css(label_color(plane.label), 0.8) +
               "\" stroke-width=\"1.2\"/><text x=\"" + text(at.x()) + "\" y=\"" + text(at.y() + 4.5) +
               "\" text-anchor=\"middle\">" + number + "</text>\n";
    }

  private:
    bool covers_another(const Eigen::Vector2d& at, double radius) const {
        return std::any_of(placed_.begin(), placed_.end(), [&](const auto& other) {
            return (other.first - at).norm() < radius + other.second;
        });
    }
    std::vector<std::pair<Eigen::Vector2d, double>> placed_;
};

/// A part of the page.
struct Area {
    Eigen::Vector2d low, high;
};
/// Between title and foot; beside the legend or all across.
Area drawing_area(bool beside_legend) {
    return {
        {kMargin_px, kTitleHeight_px + 14},
        {kPageWidth_px - (beside_legend ? kLegendWidth_px : kMargin_px), kPageHeight_px - kFootHeight_px}};
}

/// Scales and centres points in an area of the page; y of the input points up the page.
class Fit {
  public:
    Fit(const std::vector<Eigen::Vector2d>& points, const Area& area)
        : centre_(0.5 * (area.low + area.high)) {
        Eigen::Vector2d low(-1, -1), high(1, 1);
        if (!points.empty()) low = high = points[0];
        for (const Eigen::Vector2d& p : points) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        const Eigen::Vector2d size = (high - low).cwiseMax(1e-3);
        scale_ = (area.high - area.low).cwiseQuotient(size).minCoeff();
        middle_ = 0.5 * (low + high);
    }
    double scale() const { return scale_; }
    Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
        const Eigen::Vector2d q = scale_ * (p - middle_);
        return {centre_.x() + q.x(), centre_.y() - q.y()};
    }

  private:
    double scale_ = 1;  ///< pixels per metre
    Eigen::Vector2d centre_, middle_;
};

/// 1, 2 or 5 times a power of ten, the largest that is not over `most`.
double round_length(double most) {
    const double power = std::pow(10, std::floor(std::log10(most)));
    return power * (5 * power <= most ? 5 : 2 * power <= most ? 2 : 1);
}

std::string metres(double length) {
    std::array<char, 32> buffer;
    return std::string(buffer.data(),
                       std::to_chars(buffer.data(), buffer.data() + buffer.size(), length).ptr) +
           " m";
}

/// A bar in the foot of the page, about a sixth of its width.
std::string scale_bar(double pixels_per_metre) {
    const double length = round_length(kPageWidth_px / 6 / pixels_per_metre);
    const double x = kMargin_px, y = kPageHeight_px - 16, end = x + length * pixels_per_metre;
    return "<path d=\"" + move_to({x, y - 5}) + "v5H" + text(end) +
           "v-5\" fill=\"none\" stroke=\"black\"/>\n" +
           words({0.5 * (x + end), y - 6}, metres(length), "text-anchor=\"middle\"");
}

/// What became of the planes of a map in the overhead drawing.
struct Shown {
    const MapPlane* plane;
    bool drawn, numbered;
};

/// Every plane of the map by its label, with the label's colour; beside the drawing.
std::string legend(const std::vector<Shown>& planes, std::size_t all) {
    const double x = kPageWidth_px - kLegendWidth_px + 24;
    double y = kTitleHeight_px + 30;
    std::string svg;
    const auto line = [&](const std::string& mark, const std::string& what, const char* attributes = "") {
        svg += mark + words({x + 26, y + 4.5}, what, attributes);
        y += 22;
    };
    std::size_t hidden_count = 0, small_count = 0;
    for (const PlaneLabel label : {PlaneLabel::kFloor, PlaneLabel::kCeiling, PlaneLabel::kWall,
                                   PlaneLabel::kHorizontal, PlaneLabel::kOther, PlaneLabel::kUnknown}) {
        std::size_t count = 0, hidden = 0;
        for (const Shown& shown : planes) {
            if (shown.plane->label != label) continue;
            ++count;
            hidden += shown.drawn ? 0 : 1;
            small_count += shown.drawn && !shown.numbered ? 1 : 0;
        }
        hidden_count += hidden;
        if (count == 0) continue;
        line("<rect x=\"" + text(x) + "\" y=\"" + text(y - 7) + "\" width=\"18\" height=\"14\" fill=\"" +
                 css(label_color(label)) + "\" stroke=\"#555\" stroke-width=\"0.7\"/>",
             std::string(label_name(label)) + " (" + std::to_string(count) + ")" +
                 (hidden == 0       ? ""
                  : hidden == count ? ", not drawn"
                                    : ", " + std::to_string(hidden) + " not drawn"));
    }
    line("<path d=\"" + move_to({x, y}) + "h18\" stroke=\"" + css(kTrajectoryColor) +
             "\" stroke-width=\"2\"/>",
         "trajectory, from the green dot");
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
        const bool drawn = upward >= -0.35;
        shown.push_back({plane, drawn, drawn && plane->area >= kNumberedArea_m2});
        if (!drawn) continue;
        (upward > 0.35 ? surfaces : walls).push_back(plane);
        for (const auto& ring : world_rings(*plane))
            for (const auto& p : ring) extent.push_back((level * p).head<2>());
    }
    for (const StampedPose& pose : trajectory)
        extent.push_back((level * pose.world_from_camera.translation()).head<2>());
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [&](auto* a, auto* b) { return height(a) < height(b); });

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
    for (const MapPlane* plane : walls) {
        std::string d;
        for (const auto& [from, to] : footprint(*plane, level)) d += move_to(fit(from)) + line_to(fit(to));
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
                    legend(shown, map.planes.size()));
}

namespace {

/// A camera outside a bounding sphere.
struct View {
    Eigen::Vector3d eye;
    Eigen::Matrix3d view_from_world;  ///< x right, y up, z towards the viewer

    Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d q = view_from_world * (p - eye);
        return q.head<2>() / -q.z();
    }
    bool is_in_front_of(const Plane& plane) const { return plane.signed_distance(eye) > 0; }
};

View looking_from(double azimuth, const Eigen::Matrix3d& level, const Eigen::Vector3d& centre,
                  double radius) {
    constexpr double kElevation = 50 * std::numbers::pi / 180;
    const Eigen::Vector3d in_level(std::cos(kElevation) * std::cos(azimuth),
                                   std::cos(kElevation) * std::sin(azimuth), std::sin(kElevation));
    View view;
    const Eigen::Vector3d back = level.transpose() * in_level;
    view.eye = centre + 3.2 * radius * back;
    const Eigen::Vector3d right = level.row(2).transpose().cross(back).normalized();
    view.view_from_world << right.transpose(), back.cross(right).transpose(), back.transpose();
    return view;
}

/// The corner view that shows the most area.
View best_view(const std::vector<const MapPlane*>& planes, const Eigen::Matrix3d& level) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const MapPlane* plane : planes) {
        for (const Eigen::Vector3d& corner : plane->box().face()) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    }
    if (planes.empty()) low = high = Eigen::Vector3d::Zero();
    const Eigen::Vector3d centre = 0.5 * (low + high);
    const double radius = std::max(0.5, 0.5 * (high - low).norm());
    View best;
    double best_area = -1;
    for (int i = 0; i < 8; ++i) {
        const View view = looking_from((i + 0.3) * std::numbers::pi / 4, level, centre, radius);
        double area = 0;
        for (const MapPlane* plane : planes) {
            const Eigen::Vector3d towards = view.eye - plane->center.cast<double>();
            area += plane->area * std::max(0.0, plane->normal.cast<double>().dot(towards.normalized()));
        }
        if (area > best_area) {
            best = view;
            best_area = area;
        }
    }
    return best;
}

struct Drawn {
    const MapPlane* plane;
    Polygon3 rings;
    Eigen::Vector2d low, high;  ///< on the page
    double depth;               ///< of the centre
};

/// True when a's plane separates the two and b is on the viewer's side, or b's does and a is beyond.
bool is_behind(const Drawn& a, const Drawn& b, const Eigen::Vector3d& eye) {
    constexpr double kSlack_m = 0.03;
    const auto all_on_side = [&](const Polygon3& rings, const Plane& plane, double side) {
        for (const auto& ring : rings)
            for (const auto& p : ring)
                if (side * plane.signed_distance(p) < -kSlack_m) return false;
        return true;
    };
    const Plane plane_a = a.plane->plane(), plane_b = b.plane->plane();
    return all_on_side(b.rings, plane_a, plane_a.signed_distance(eye) > 0 ? 1 : -1) ||
           all_on_side(a.rings, plane_b, plane_b.signed_distance(eye) > 0 ? -1 : 1);
}

/// Order for the painter's algorithm, farthest first: what lies behind another plane comes before it; where
/// planes cross or overlap in a circle, the farther centre does.
std::vector<Drawn> painters_order(std::vector<Drawn> planes, const Eigen::Vector3d& eye) {
    std::stable_sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.depth > b.depth; });
    const std::size_t n = planes.size();
    std::vector<std::vector<std::size_t>> in_front_of(n);
    std::vector<int> waits_for(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            if ((planes[i].low.array() > planes[j].high.array()).any()) continue;
            if ((planes[j].low.array() > planes[i].high.array()).any()) continue;
            const bool i_behind = is_behind(planes[i], planes[j], eye),
                       j_behind = is_behind(planes[j], planes[i], eye);
            if (i_behind == j_behind) continue;
            in_front_of[i_behind ? i : j].push_back(i_behind ? j : i);
            ++waits_for[i_behind ? j : i];
        }
    }
    std::vector<Drawn> order;
    std::vector<bool> done(n, false);
    while (order.size() < n) {
        std::size_t next = n;
        for (std::size_t i = 0; i < n && (next == n || waits_for[next] > 0); ++i) {
            if (!done[i] && (next == n || waits_for[i] <= 0)) next = i;
        }
        done[next] = true;
        for (const std::size_t i : in_front_of[next]) --waits_for[i];
        order.push_back(planes[next]);
    }
    return order;
}

/// A length that shows the scale of a perspective: true at its own place, at the front edge of the floor.
struct SpaceBar {
    Eigen::Vector3d from, to;
    Eigen::Vector3d tick;  ///< across it
    double length = 0;
};

/// Along the lower edge of the planes' level box that is nearest to the viewer; nothing without planes.
std::optional<SpaceBar> bar_before(const std::vector<const MapPlane*>& planes, const Eigen::Matrix3d& level,
                                   const View& view) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const MapPlane* plane : planes) {
        for (const auto& ring : world_rings(*plane)) {
            for (const Eigen::Vector3d& p : ring) {
                low = low.cwiseMin(level * p);
                high = high.cwiseMax(level * p);
            }
        }
    }
    if (!(low.array() <= high.array()).all()) return std::nullopt;
    const Eigen::Vector3d eye = level * view.eye, middle = 0.5 * (low + high), size = high - low;
    const double outside = 0.03 * size.norm();
    SpaceBar best;
    double nearest = 1e300;
    for (const int axis : {0, 1}) {
        const int across = 1 - axis;
        for (const double side : {-1.0, 1.0}) {
            Eigen::Vector3d at = middle, tick = Eigen::Vector3d::Zero();
            at.z() = low.z();
            at(across) += side * (0.5 * size(across) + outside);
            tick(across) = side * 0.4 * outside;
            if ((at - eye).norm() >= nearest) continue;
            nearest = (at - eye).norm();
            const double length = round_length(std::max(0.4 * size(axis), 0.01));
            Eigen::Vector3d half = Eigen::Vector3d::Zero();
            half(axis) = 0.5 * length;
            best = {level.transpose() * (at - half), level.transpose() * (at + half),
                    level.transpose() * tick, length};
        }
    }
    return best;
}

template <typename Project>
std::string drawn_bar(const SpaceBar& bar, const Project& project) {
    const Eigen::Vector3d middle = 0.5 * (bar.from + bar.to);
    const Eigen::Vector2d outward = (project(middle + bar.tick) - project(middle)).normalized();
    const char* anchor = outward.x() > 0.4    ? "text-anchor=\"start\""
                         : outward.x() < -0.4 ? "text-anchor=\"end\""
                                              : "text-anchor=\"middle\"";
    return "<path d=\"" + move_to(project(bar.from + bar.tick)) + line_to(project(bar.from)) +
           line_to(project(bar.to)) + line_to(project(bar.to + bar.tick)) +
           "\" fill=\"none\" stroke=\"black\" stroke-width=\"1.5\"/>\n" +
           words(project(middle) + 18 * outward + Eigen::Vector2d(0, 5), metres(bar.length), anchor);
}

}  // namespace

std::string perspective_svg(const PlaneMap& map, const Trajectory& trajectory) {
    const Eigen::Matrix3d level = level_from_world(map, up_of(map, trajectory));
    const std::vector<const MapPlane*> planes = drawable_planes(map);
    const View view = best_view(planes, level);
    std::vector<Eigen::Vector2d> extent;
    std::vector<const MapPlane*> visible;
    for (const MapPlane* plane : planes) {
        if (!view.is_in_front_of(plane->plane())) continue;
        visible.push_back(plane);
        for (const auto& ring : world_rings(*plane))
            for (const auto& p : ring) extent.push_back(view(p));
    }
    const auto bar = bar_before(visible, level, view);
    if (bar) extent.insert(extent.end(), {view(bar->from), view(bar->to)});
    const Fit fit(extent, drawing_area(false));
    const auto project = [&](const Eigen::Vector3d& p) { return fit(view(p)); };

    std::vector<Drawn> drawn;
    for (const MapPlane* plane : visible) {
        Drawn d{plane, world_rings(*plane), Eigen::Vector2d::Constant(1e300),
                Eigen::Vector2d::Constant(-1e300), (plane->center.cast<double>() - view.eye).norm()};
        for (const auto& ring : d.rings) {
            for (const auto& p : ring) {
                d.low = d.low.cwiseMin(project(p));
                d.high = d.high.cwiseMax(project(p));
            }
        }
        drawn.push_back(std::move(d));
    }

    const Eigen::Vector3d light = (level.transpose() * Eigen::Vector3d(0.35, 0.2, 0.9)).normalized();
    std::string body;
    std::vector<int> painted;
    const auto is_painted = [&](int id) {
        return std::find(painted.begin(), painted.end(), id) != painted.end();
    };
    for (const Drawn& d : painters_order(std::move(drawn), view.eye)) {
        const Rgb color = plane_color(d.plane->id);
        const double shade = 0.72 + 0.33 * std::abs(light.dot(d.plane->normal.cast<double>()));
        body += "<path d=\"" + path(d.rings, project) + "\" fill-rule=\"evenodd\" fill=\"" +
                css(color, shade) + "\" stroke=\"" + css(color, 0.6) +
                "\" stroke-width=\"0.8\" stroke-linejoin=\"round\">" + tooltip(*d.plane) + "</path>\n";
        painted.push_back(d.plane->id);
        // A line belongs to the nearer of its planes: what is painted later covers it.
        for (const IntersectionLine& line : map.lines) {
            if (line.plane_a != d.plane->id && line.plane_b != d.plane->id) continue;
            if (!is_painted(line.plane_a) || !is_painted(line.plane_b)) continue;
            body += "<path d=\"" + move_to(project(line.from.cast<double>())) +
                    line_to(project(line.to.cast<double>())) + "\" stroke=\"#222\" stroke-width=\"1.8\"/>\n";
        }
    }
    for (const IntersectionPoint& p : map.points) {
        if (!std::all_of(p.planes.begin(), p.planes.end(), is_painted)) continue;
        const Eigen::Vector2d at = project(p.position.cast<double>());
        body += "<circle cx=\"" + text(at.x()) + "\" cy=\"" + text(at.y()) + "\" r=\"3.5\" fill=\"#222\"/>\n";
    }
    const std::size_t hidden = map.planes.size() - visible.size();
    return page(count_of(map.planes.size(), "plane") + " in perspective",
                "from above a corner; a colour a plane; the bar is true where it lies" +
                    (hidden == 0 ? "" : "; " + std::to_string(hidden) + " that face away are not drawn") +
                    "; " + up_text(map),
                body + trajectory_line(trajectory, project) + (bar ? drawn_bar(*bar, project) : ""));
}

}  // namespace planemap::map
