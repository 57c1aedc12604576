// SPDX-License-Identifier: BSD-3-Clause
#include "map/labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/angle.hpp"
#include "map/standing.hpp"

namespace planemap::map {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Level planes at one height, facing the same way.
struct Level {
    std::vector<const Standing*> pieces;  ///< the one with the most support first
    double area = 0, support = 0;

    double height() const { return pieces.front()->height; }
};

struct Storey {
    double floor = -kInfinity, next_floor = kInfinity;  ///< heights
    double ceiling = kInfinity;
};

class Labeller {
  public:
    Labeller(PlaneMap& map, std::span<const Pose> world_from_camera, const Eigen::Vector3d& up,
             const LabelRules& rules)
        : rules_(rules), up_(up), planes_(standing_planes(map, up, radians(rules.gravity.tolerance_deg))) {
        for (const Pose& pose : world_from_camera) {
            const double height = up.dot(pose.translation());
            if (std::isfinite(height)) cameras_.push_back(height);
        }
        std::sort(cameras_.begin(), cameras_.end());
    }

    void label() {
        for (const Standing& s : planes_)
            s.plane->label = s.is_level()             ? PlaneLabel::kHorizontal
                             : s.lie == Lie::kUpright ? PlaneLabel::kVertical
                                                      : PlaneLabel::kOther;
        std::vector<Storey> storeys = label_floors();
        for (Storey& storey : storeys) label_ceiling(storey);
        for (const Standing& s : planes_) {
            if (s.lie == Lie::kUpright && is_wall(s, storeys)) s.plane->label = PlaneLabel::kWall;
        }
    }

  private:
    /// Share of the cameras between two heights.
    double cameras_between(double low, double high) const {
        if (cameras_.empty()) return 0;
        const auto from = std::lower_bound(cameras_.begin(), cameras_.end(), low);
        const auto to = std::upper_bound(from, cameras_.end(), high);
        return static_cast<double>(to - from) / static_cast<double>(cameras_.size());
    }

    /// At the same height, or (in a long room a small tilt makes a difference) on the same plane.
    bool same_height(const Standing& a, const Standing& lead) const {
        const double least = std::min(a.area, lead.area);
        const double limit = least < rules_.piece_area_m2 ? rules_.scrap_height_m : rules_.same_height_m;
        return std::abs(a.height - lead.height) < limit ||
               std::abs((a.center - lead.center).dot(lead.normal)) < limit;
    }

    /// Support of what is not of the level between two heights.
    double support_between(double low, double high, const Level& level) const {
        double support = 0;
        for (const Standing& s : planes_) {
            const Standing& lead = *level.pieces.front();
            if (s.lie != lead.lie || !same_height(s, lead)) support += s.support_between(low, high);
        }
        return support;
    }

    /// From the lowest up.
    std::vector<Level> levels(Lie lie) const {
        std::vector<Level> found;
        for (const Standing& s : planes_) {
            if (s.lie != lie) continue;
            auto level = std::find_if(found.begin(), found.end(),
                                      [&](const Level& l) { return same_height(s, *l.pieces.front()); });
            if (level == found.end()) level = found.insert(found.end(), Level{});
            level->pieces.push_back(&s);
            level->area += s.area;
            level->support += s.support;
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

    static bool is_labelled(const Level& level, PlaneLabel label) {
        return level.pieces.front()->plane->label == label;
    }

    /// Below the cameras and with next to nothing below it.
    bool is_lowest(const Level& level) const {
        const double h = level.height();
        return cameras_between(h, kInfinity) > 0.8 &&
               support_between(-kInfinity, h - 1.5 * rules_.same_height_m, level) <=
                   rules_.beyond_area * level.support;
    }

    bool is_stood_on(const Level& level) const {
        const double h = level.height();
        return cameras_between(h + rules_.same_height_m, h + rules_.standing_m) >= rules_.standing_share;
    }

    /// The storeys, from the lowest up; one without a floor if none is seen.
    std::vector<Storey> label_floors() const {
        const std::vector<Level> all = levels(Lie::kFacesUp);
        std::vector<Level> candidates = all;
        std::erase_if(candidates, [&](const Level& level) { return !is_floor_sized(level); });
        // The lowest floor is no mere scrap beside another.
        double strongest = 0;
        for (const Level& level : candidates)
            if (is_lowest(level)) strongest = std::max(strongest, level.support);
        std::vector<Storey> storeys;
        for (const Level& level : candidates) {
            const double h = level.height();
            const bool is_floor = storeys.empty()
                                      ? is_lowest(level) && level.support >= rules_.weakest * strongest
                                      : h > storeys.back().floor + rules_.storey_m && is_stood_on(level);
            if (!is_floor) continue;
            set_label(level, PlaneLabel::kFloor);
            if (!storeys.empty()) storeys.back().next_floor = h;
            storeys.push_back({h});
        }
        label_steps(all);
        if (storeys.empty()) storeys.push_back({});
        return storeys;
    }

    /// Floors go on where a large surface lies a step higher, or a smaller one, as no furniture is lower than
    /// the floor, a step lower; until there are no more.
    void label_steps(const std::vector<Level>& all) const {
        const auto is_step = [&](const Level& level, const Level& floor) {
            const double rise = level.height() - floor.height();
            return is_labelled(floor, PlaneLabel::kFloor) && std::abs(rise) <= rules_.step_m &&
                   level.area >= (rise > 0 ? rules_.floor_area_m2 : rules_.high_floor_area_m2) &&
                   (cameras_.size() < 2 || level.pieces.front()->plane->keyframes > 1);
        };
        for (bool found = true; found;) {
            found = false;
            for (const Level& level : all) {
                if (is_labelled(level, PlaneLabel::kFloor)) continue;
                if (std::none_of(all.begin(), all.end(), [&](auto& floor) { return is_step(level, floor); }))
                    continue;
                set_label(level, PlaneLabel::kFloor);
                found = true;
            }
        }
    }

    void label_ceiling(Storey& storey) const {
        const bool no_floor = std::isinf(storey.floor);
        if (no_floor && cameras_.empty()) return;
        const double from =
            no_floor ? cameras_[cameras_.size() * 4 / 5] : storey.floor + rules_.ceiling_height_m;
        std::vector<Level> candidates = levels(Lie::kFacesDown);
        std::erase_if(candidates, [&](const Level& level) {
            return level.height() < from || level.height() > storey.next_floor + rules_.same_height_m;
        });
        const Level* ceiling = nullptr;
        for (const Level& level : candidates) {
            const double above = support_between(level.height() + 1.5 * rules_.same_height_m,
                                                 storey.next_floor - rules_.same_height_m, level);
            if (level.area < rules_.ceiling_area_m2 || above > rules_.beyond_area * level.support) continue;
            if (ceiling == nullptr || level.support > ceiling->support) ceiling = &level;
        }
        if (ceiling == nullptr) return;
        for (const Level& level : candidates) {
            const double below = ceiling->height() - level.height();
            if (below > (level.area < rules_.ceiling_area_m2 ? 0 : rules_.step_m)) continue;
            set_label(level, PlaneLabel::kCeiling);
            storey.ceiling = std::min(storey.ceiling, level.height());
        }
    }

    bool is_wall(const Standing& s, const std::vector<Storey>& storeys) const {
        if (s.area < rules_.wall_area_m2) return false;
        const Storey* storey = &storeys.front();
        for (const Storey& other : storeys)
            if (other.floor < s.height) storey = &other;
        if (s.high > storey->ceiling - rules_.at_ceiling_m) return true;
        if (2 * s.half_length(s.normal.cross(up_)) < rules_.wall_width_m) return false;
        if (is_seen_over(s, planes_, up_) || has_top(s, planes_, up_)) return false;
        return s.high - s.low >= rules_.wall_height_m || s.area >= rules_.large_wall_area_m2 ||
               (std::isfinite(storey->floor) && s.high >= storey->floor + rules_.wall_top_m);
    }

    const LabelRules& rules_;
    const Eigen::Vector3d up_;
    std::vector<Standing> planes_;  ///< those with the most support first
    std::vector<double> cameras_;   ///< heights, ascending
};

}  // namespace

void label_planes(PlaneMap& map, const Up& up, std::span<const Pose> world_from_camera,
                  const LabelRules& rules) {
    map.up.setZero();
    for (MapPlane& plane : map.planes) plane.label = PlaneLabel::kUnknown;
    if (!up.direction) return;
    map.up = up.direction->cast<float>().normalized();
    Labeller(map, world_from_camera, *up.direction, rules).label();
}

Up label_planes(PlaneMap& map, std::span<const Pose> world_from_camera, const LabelRules& rules) {
    Up up = find_up(map.planes, world_from_camera, rules.gravity);
    label_planes(map, up, world_from_camera, rules);
    return up;
}

}  // namespace planemap::map
