// SPDX-License-Identifier: BSD-3-Clause
#include "map/labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/angle.hpp"

namespace planemap::map {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Lie { kFacesUp, kFacesDown, kUpright, kOblique };

/// A plane of the map with its heights along up, metres.
struct Standing {
    MapPlane* plane = nullptr;
    Lie lie = Lie::kOblique;
    double area = 0;
    double height = 0;         ///< of the centre
    double low = 0, high = 0;  ///< of the outline

    double area_between(double from, double to) const {
        const double inside = std::min(high, to) - std::max(low, from);
        return inside >= 0 ? area * std::min(1.0, (inside + 1e-3) / (high - low + 1e-3)) : 0;
    }
};

/// Level planes at one height, facing the same way.
struct Level {
    std::vector<const Standing*> pieces;  ///< the largest first
    double area = 0;

    double height() const { return pieces.front()->height; }
};

struct Storey {
    double floor = -kInfinity, next_floor = kInfinity;  ///< heights
};

class Labeller {
  public:
    Labeller(PlaneMap& map, std::span<const Pose> world_from_camera, const Eigen::Vector3d& up,
             const LabelRules& rules)
        : rules_(rules), up_(up) {
        for (const Pose& pose : world_from_camera) {
            const double height = up.dot(pose.translation());
            if (std::isfinite(height)) cameras_.push_back(height);
        }
        std::sort(cameras_.begin(), cameras_.end());
        planes_.reserve(map.planes.size());
        for (MapPlane& plane : map.planes) add(plane);
        std::stable_sort(planes_.begin(), planes_.end(), [](auto& a, auto& b) { return a.area > b.area; });
    }

    void label() {
        for (const Standing& s : planes_)
            s.plane->label = is_level(s) ? PlaneLabel::kHorizontal : PlaneLabel::kOther;
        const std::vector<Storey> storeys = label_floors();
        for (const Storey& storey : storeys) label_ceiling(storey);
        for (const Standing& s : planes_) {
            if (s.lie == Lie::kUpright && is_wall(s, storeys)) s.plane->label = PlaneLabel::kWall;
        }
    }

  private:
    static bool is_level(const Standing& s) { return s.lie == Lie::kFacesUp || s.lie == Lie::kFacesDown; }

    void add(MapPlane& plane) {
        const bool is_plane = std::abs(plane.normal.norm() - 1) < 1e-3f && plane.center.allFinite();
        if (!is_plane || !std::isfinite(plane.area) || !std::isfinite(plane.angle)) return;
        const double tolerance = radians(rules_.gravity.tolerance_deg);
        const Pose world_from_plane = plane.world_from_plane();
        const Eigen::Vector3d slope = world_from_plane.linear().transpose() * up_;
        Standing s;
        s.plane = &plane;
        s.area = static_cast<double>(plane.area);
        s.height = up_.dot(world_from_plane.translation());
        if (std::abs(slope.z()) > std::cos(tolerance)) {
            s.lie = slope.z() > 0 ? Lie::kFacesUp : Lie::kFacesDown;
        } else if (std::abs(slope.z()) < std::sin(tolerance)) {
            s.lie = Lie::kUpright;
        }
        find_extent(plane.outline, slope, s);
        planes_.push_back(s);
    }

    /// The outline's lowest and highest vertex, without unpacking it.
    static void find_extent(const MapOutline& outline, const Eigen::Vector3d& slope, Standing& s) {
        const Eigen::Vector2d per_step = static_cast<double>(outline.unit) * slope.head<2>();
        s.low = outline.empty() ? s.height : kInfinity;
        s.high = outline.empty() ? s.height : -kInfinity;
        for_each_packed(
            outline.packed, [](std::size_t) {},
            [&](std::int16_t x, std::int16_t y) {
                const double height = s.height + per_step.x() * x + per_step.y() * y;
                s.low = std::min(s.low, height);
                s.high = std::max(s.high, height);
            });
    }

    /// Share of the cameras between two heights.
    double cameras_between(double low, double high) const {
        const auto from = std::lower_bound(cameras_.begin(), cameras_.end(), low);
        const auto to = std::upper_bound(from, cameras_.end(), high);
        return static_cast<double>(to - from) / static_cast<double>(cameras_.size());
    }

    /// At the same height, or (in a long room a small tilt makes a difference) on the same plane.
    bool same_height(const Standing& a, const Standing& b) const {
        const auto beside = [](const Standing& s, const Standing& lead) {
            return std::abs((s.plane->center - lead.plane->center).dot(lead.plane->normal));
        };
        return std::abs(a.height - b.height) < rules_.same_height_m || beside(a, b) < rules_.same_height_m;
    }

    /// Area of what is not of the level between two heights.
    double area_between(double low, double high, const Level& level) const {
        double area = 0;
        for (const Standing& s : planes_) {
            const Standing& lead = *level.pieces.front();
            if (s.lie != lead.lie || !same_height(s, lead)) area += s.area_between(low, high);
        }
        return area;
    }

    std::vector<Level> levels(Lie lie) const {
        std::vector<Level> found;
        for (const Standing& s : planes_) {
            if (s.lie != lie) continue;
            auto level = std::find_if(found.begin(), found.end(),
                                      [&](const Level& l) { return same_height(s, *l.pieces.front()); });
            if (level == found.end()) level = found.insert(found.end(), Level{});
            level->pieces.push_back(&s);
            level->area += s.area;
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const Level& a, const Level& b) { return a.height() < b.height(); });
        return found;
    }

    bool is_floor_sized(const Level& level) const {
        const bool too_far_below_for_a_table =
            cameras_between(level.height() + rules_.above_tables_m, kInfinity) > 0.5;
        return level.area >= (too_far_below_for_a_table ? rules_.high_floor_area_m2 : rules_.floor_area_m2);
    }

    static void set_label(const Level& level, PlaneLabel label) {
        for (const Standing* s : level.pieces) s->plane->label = label;
    }

    /// The storeys, from the lowest up; one without a floor if none is seen.
    std::vector<Storey> label_floors() const {
        std::vector<Level> candidates = levels(Lie::kFacesUp);
        std::erase_if(candidates, [&](const Level& level) { return !is_floor_sized(level); });
        // The lowest floor: the lowest of those with next to nothing below, but no mere scrap beside another.
        const auto is_lowest = [&](const Level& level) {
            const double h = level.height();
            return cameras_between(h, kInfinity) > 0.8 &&
                   area_between(-kInfinity, h - 1.5 * rules_.same_height_m, level) <=
                       rules_.beyond_area * level.area;
        };
        double largest = 0;
        for (const Level& level : candidates)
            if (is_lowest(level)) largest = std::max(largest, level.area);
        std::vector<Storey> storeys;
        for (const Level& level : candidates) {
            const double h = level.height();
            const bool is_floor = storeys.empty()
                                      ? is_lowest(level) && level.area >= 0.1 * largest
                                      : h > storeys.back().floor + rules_.storey_m &&
                                            cameras_between(h + rules_.same_height_m,
                                                            h + rules_.standing_m) >= rules_.standing_share;
            if (!is_floor) continue;
            set_label(level, PlaneLabel::kFloor);
            if (!storeys.empty()) storeys.back().next_floor = h;
            storeys.push_back({h, kInfinity});
        }
        if (storeys.empty()) storeys.push_back({});
        return storeys;
    }

    void label_ceiling(const Storey& storey) const {
        const bool no_floor = std::isinf(storey.floor);
        const double from =
            no_floor ? cameras_[cameras_.size() * 4 / 5] : storey.floor + rules_.ceiling_height_m;
        std::vector<Level> candidates = levels(Lie::kFacesDown);
        std::erase_if(candidates, [&](const Level& level) {
            return level.height() < from || level.height() > storey.next_floor + rules_.same_height_m;
        });
        const Level* ceiling = nullptr;
        for (const Level& level : candidates) {
            const double above = area_between(level.height() + 1.5 * rules_.same_height_m,
                                              storey.next_floor - rules_.same_height_m, level);
            if (level.area < rules_.ceiling_area_m2 || above > rules_.beyond_area * level.area) continue;
            if (ceiling == nullptr || level.area > ceiling->area) ceiling = &level;
        }
        if (ceiling == nullptr) return;
        for (const Level& level : candidates)
            if (level.height() >= ceiling->height()) set_label(level, PlaneLabel::kCeiling);
    }

    bool is_wall(const Standing& s, const std::vector<Storey>& storeys) const {
        if (s.area < rules_.wall_area_m2) return false;
        double floor = kInfinity;
        for (const Storey& storey : storeys)
            if (storey.floor < s.height) floor = storey.floor;
        return s.high - s.low >= rules_.wall_height_m || s.area >= rules_.large_wall_area_m2 ||
               (std::isfinite(floor) && s.high >= floor + rules_.wall_top_m);
    }

    const LabelRules& rules_;
    const Eigen::Vector3d up_;
    std::vector<double> cameras_;   ///< heights, ascending
    std::vector<Standing> planes_;  ///< the largest first
};

}  // namespace

void label_planes(PlaneMap& map, std::span<const Pose> world_from_camera, const LabelRules& rules) {
    map.up.setZero();
    for (MapPlane& plane : map.planes) plane.label = PlaneLabel::kUnknown;
    const std::optional<Eigen::Vector3d> up = find_up(map.planes, world_from_camera, rules.gravity);
    if (!up) return;
    map.up = up->cast<float>().normalized();
    Labeller(map, world_from_camera, *up, rules).label();
}

}  // namespace planemap::map
