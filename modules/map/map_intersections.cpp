// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_intersections.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace planemap::map {

namespace {

/// Triples of planes looked at for points in one update. Ten storeys with a hundred rooms each take a tenth.
constexpr std::size_t kMaxTriples = std::size_t{1} << 22;

}  // namespace

void MapIntersections::update(PlaneMap& map, const std::vector<int>& changed_ids) {
    if (changed_ids.empty()) return;
    const auto is_changed = [&](int id) {
        return std::binary_search(changed_ids.begin(), changed_ids.end(), id);
    };
    for (const int id : changed_ids) {
        if (const MapPlane* plane = map.find(id)) {
            shapes_[id] = PlaneShape(*plane);
        } else {
            shapes_.erase(id);
        }
    }
    for (auto* lines : {&lines_, &reached_})
        std::erase_if(*lines,
                      [&](auto& line) { return is_changed(line.plane_a) || is_changed(line.plane_b); });
    std::erase_if(map.points, [&](auto& point) {
        return std::any_of(point.planes.begin(), point.planes.end(), is_changed);
    });
    add_lines(changed_ids, is_changed);
    add_points(map, is_changed);
    map.lines = lines_;
    end_at_points(map.points, map.lines);
    meetings_ = reached_;
    end_at_points(map.points, meetings_);
    map.lines.shrink_to_fit();
    map.points.shrink_to_fit();
}

template <typename IsChanged>
void MapIntersections::add_lines(const std::vector<int>& changed_ids, IsChanged is_changed) {
    for (const int a : changed_ids) {
        const auto shape_a = shapes_.find(a);
        if (shape_a == shapes_.end()) continue;
        for (const auto& [b, shape_b] : shapes_) {
            if (b == a || (b < a && is_changed(b))) continue;
            const auto lines = intersection_lines(shape_a->second, shape_b, rules_);
            lines_.insert(lines_.end(), lines.begin(), lines.end());
            if (lines.empty()) continue;
            AdjacencyRules nearer = rules_;
            const Eigen::Vector3d across = shape_a->second.plane.normal.cross(shape_b.plane.normal);
            nearer.gap_m = meeting_reach(shape_a->second.rms, shape_b.rms, across.norm(), rules_);
            const auto reached = intersection_lines(shape_a->second, shape_b, nearer);
            reached_.insert(reached_.end(), reached.begin(), reached.end());
        }
    }
    for (auto* lines : {&lines_, &reached_}) {
        std::stable_sort(lines->begin(), lines->end(), [](auto& x, auto& y) {
            return std::pair(x.plane_a, x.plane_b) < std::pair(y.plane_a, y.plane_b);
        });
    }
}

/// Points where three planes meet of which one changed. Rooms have a few for each plane; what could be a map,
/// and has a thousand planes that all meet, would have more than can be found.
template <typename IsChanged>
void MapIntersections::add_points(PlaneMap& map, IsChanged is_changed) {
    std::map<int, std::set<int>> above;  // adjacent planes with a larger id
    for (const IntersectionLine& line : lines_) above[line.plane_a].insert(line.plane_b);
    std::size_t triples = 0;
    const auto add_all = [&] {
        for (const auto& [a, adjacent] : above) {
            for (const int b : adjacent) {
                const auto beyond = above.find(b);
                if (beyond == above.end()) continue;
                triples += beyond->second.size();
                if (triples > kMaxTriples) return false;
                for (const int c : beyond->second) {
                    if (!adjacent.contains(c) || !(is_changed(a) || is_changed(b) || is_changed(c))) continue;
                    const auto point =
                        intersection_point(shapes_.at(a), shapes_.at(b), shapes_.at(c), rules_);
                    if (point) map.points.push_back(*point);
                }
            }
        }
        return true;
    };
    left_out_points_ = !add_all();
    std::sort(map.points.begin(), map.points.end(), [](auto& x, auto& y) { return x.planes < y.planes; });
}

void MapIntersections::end_at_points(const std::vector<IntersectionPoint>& points,
                                     std::vector<IntersectionLine>& lines) const {
    std::map<std::pair<int, int>, std::vector<Eigen::Vector3f>> of_pair;
    for (const IntersectionPoint& point : points) {
        const auto [a, b, c] = point.planes;
        for (const auto& pair : {std::pair(a, b), std::pair(a, c), std::pair(b, c)})
            of_pair[pair].push_back(point.position);
    }
    const auto gap = static_cast<float>(rules_.gap_m);
    for (IntersectionLine& line : lines) {
        const auto near = of_pair.find({line.plane_a, line.plane_b});
        if (near == of_pair.end()) continue;
        const Eigen::Vector3f from = line.from, to = line.to;
        for (Eigen::Vector3f* end : {&line.from, &line.to}) {
            const Eigen::Vector3f at = *end;
            float least = gap;
            for (const Eigen::Vector3f& point : near->second) {
                const float off = (point - at).norm();
                // The line keeps its direction.
                if (off > least || (point - (end == &line.from ? to : from)).norm() <= 2 * gap) continue;
                least = off;
                *end = point;
            }
        }
    }
}

const Plane* MapIntersections::plane(int id) const {
    const auto shape = shapes_.find(id);
    return shape == shapes_.end() ? nullptr : &shape->second.plane;
}

std::size_t MapIntersections::memory_bytes() const {
    std::size_t bytes =
        (lines_.capacity() + reached_.capacity() + meetings_.capacity()) * sizeof(IntersectionLine);
    for (const auto& [id, shape] : shapes_)
        bytes += sizeof shape + shape.outline.vertex_count() * sizeof(Eigen::Vector2d);
    return bytes;
}

}  // namespace planemap::map
