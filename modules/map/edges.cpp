// SPDX-License-Identifier: BSD-3-Clause
#include "map/edges.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/crossing.hpp"
#include "core/geometry/segment.hpp"

namespace planemap::map {

namespace {

/// Shorter pieces along a meeting line are not made an edge of their own, in cells.
constexpr double kLeastRun = 4;
/// Cells that end at a line have their corners within so many cells of it.
constexpr double kOnLine = 1.5;
/// How far from the crossing of two meeting lines the outline may turn from one to the other, in cells.
constexpr double kCornerReach = 3;
/// Edges at a smaller angle (sine) have no corner that their lines could tell.
constexpr double kLeastTurn = 0.35;

/// A line in the plane; `along` is a unit vector.
struct Line2 {
    Eigen::Vector2d p, along;

    double offset(const Eigen::Vector2d& q) const { return cross(along, q - p); }
    Eigen::Vector2d foot(const Eigen::Vector2d& q) const { return p + along.dot(q - p) * along; }
};

std::optional<Eigen::Vector2d> crossing_of(const Line2& a, const Line2& b) {
    const double sine = cross(a.along, b.along);
    if (std::abs(sine) < kLeastTurn) return std::nullopt;
    return a.p + cross(b.p - a.p, b.along) / sine * a.along;
}

/// A vertex of a traced ring.
struct Vertex {
    Eigen::Vector2d p;
    int line = -1;       ///< the meeting line that it is on; -1: none
    int next_line = -1;  ///< at a corner: the other one, on which the path goes on
    bool fixed = false;  ///< an end of an edge on a meeting line: it stays
};
using Path = std::vector<Vertex>;

/// Where a plane's outline is laid on the lines where others meet it.
class RingSnapper {
  public:
    RingSnapper(const std::vector<MeetingLine>& lines, double cell_m) : cell_m_(cell_m) {
        for (const MeetingLine& line : lines) {
            const double length = (line.to - line.from).norm();
            if (!(length > 0)) continue;
            lines_.push_back({line.from, (line.to - line.from) / length});
            lengths_.push_back(length);
        }
    }
    const Line2& line(int index) const { return lines_[static_cast<std::size_t>(index)]; }

    /// The ring with vertices on meeting lines, whose ends are fixed.
    Path snapped(const Ring& ring) const {
        Path path = divided(ring);
        for (Vertex& vertex : path) {
            vertex.line = nearest(vertex.p);
            if (vertex.line >= 0) vertex.p = line(vertex.line).foot(vertex.p);
        }
        drop_short_runs(path);
        turn_at_crossings(path);
        for (std::size_t i = 0; i < path.size(); ++i) {
            const Vertex &before = path[(i + path.size() - 1) % path.size()],
                         &after = path[(i + 1) % path.size()];
            Vertex& vertex = path[i];
            if (vertex.line < 0) continue;
            const int comes_on = before.next_line >= 0 ? before.next_line : before.line;
            vertex.fixed = vertex.next_line >= 0 || comes_on != vertex.line || after.line != vertex.line;
        }
        return path;
    }

  private:
    /// The nearest line within reach of the point, or -1.
    int nearest(const Eigen::Vector2d& p) const {
        double least = kOnLine * cell_m_;
        int best = -1;
        for (std::size_t k = 0; k < lines_.size(); ++k) {
            const double along = lines_[k].along.dot(p - lines_[k].p);
            if (along < -cell_m_ || along > lengths_[k] + cell_m_) continue;
            const double off = std::abs(lines_[k].offset(p));
            if (off < least) least = off, best = static_cast<int>(k);
        }
        return best;
    }

    /// The ring with no edge longer than two cells where a line is near.
    Path divided(const Ring& ring) const {
        Path path;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Eigen::Vector2d &from = ring[i], &to = ring[(i + 1) % ring.size()];
            path.push_back({from});
            const double length = (to - from).norm();
            if (lines_.empty() || length <= 2 * cell_m_) continue;
            const int pieces = static_cast<int>(std::ceil(length / (2 * cell_m_)));
            for (int k = 1; k < pieces; ++k) {
                const Eigen::Vector2d p = from + k * (to - from) / pieces;
                if (nearest(p) >= 0) path.push_back({p});
            }
        }
        return path;
    }

    /// Index where a run begins; 0 if all of the path is one run.
    static std::size_t first_of_a_run(const Path& path) {
        for (std::size_t i = 1; i < path.size(); ++i)
            if (path[i].line != path[i - 1].line) return i;
        return 0;
    }

    /// Lets the path begin within its longest run on a line.
    void drop_short_runs(Path& path) const {
        std::rotate(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(first_of_a_run(path)),
                    path.end());
        std::size_t longest = 0, middle = 0;
        for (std::size_t from = 0, to = 0; from < path.size(); from = to) {
            while (to < path.size() && path[to].line == path[from].line) ++to;
            if (path[from].line < 0) continue;
            if (to - from < 3 || (path[to - 1].p - path[from].p).norm() < kLeastRun * cell_m_) {
                for (std::size_t i = from; i < to; ++i) path[i].line = -1;
            } else if (to - from > longest) {
                longest = to - from;
                middle = from + longest / 2;
            }
        }
        std::rotate(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(middle), path.end());
    }

    /// Puts one vertex where the outline turns from a line to another that crosses it there, and none where
    /// it leaves a line and soon comes back.
    void turn_at_crossings(Path& path) const {
        Path result;
        const std::size_t n = path.size();
        std::size_t first = 0;  // what comes before it has gone into a corner
        for (std::size_t i = 0; i < n; i = std::max(i + 1, first)) {
            result.push_back(path[i]);
            if (path[i].line < 0 || i + 1 >= n || path[i + 1].line == path[i].line) continue;
            std::size_t next = i + 1;
            const double reach = kCornerReach * cell_m_;
            while (next < n && path[next].line < 0 && (path[next].p - path[i].p).norm() <= 2 * reach) ++next;
            if (next >= n || path[next].line < 0) continue;
            const Vertex& other = path[next];
            if (other.line == path[i].line) {
                if ((other.p - path[i].p).norm() <= reach) first = next;
                continue;
            }
            const auto corner = crossing_of(line(path[i].line), line(other.line));
            if (!corner || (*corner - path[i].p).norm() > reach || (*corner - other.p).norm() > reach)
                continue;
            result.back().p = *corner;
            result.back().next_line = other.line;
            first = next + 1;
        }
        path = std::move(result);
    }

    double cell_m_;
    std::vector<Line2> lines_;
    std::vector<double> lengths_;
};

/// Takes out the corners that enclose less than `least_m2` with their neighbours, the least first.
void drop_teeth(const Path& path, double least_m2, std::vector<std::size_t>& kept) {
    while (kept.size() > 3) {
        double least = least_m2;
        std::size_t at = kept.size();
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (path[kept[i]].fixed) continue;
            const Eigen::Vector2d &a = path[kept[(i + kept.size() - 1) % kept.size()]].p,
                                  &b = path[kept[i]].p, &c = path[kept[(i + 1) % kept.size()]].p;
            const double enclosed = 0.5 * std::abs(cross(b - a, c - a));
            if (enclosed < least) least = enclosed, at = i;
        }
        if (at == kept.size()) return;
        kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(at));
    }
}

/// Which vertices of a closed path stay: by Douglas and Peucker between those that are fixed, without teeth.
std::vector<std::size_t> kept_of(const Path& path, double tolerance, double least_m2) {
    Ring ring;
    std::vector<std::uint8_t> fixed;
    for (const Vertex& vertex : path) {
        ring.push_back(vertex.p);
        fixed.push_back(vertex.fixed ? 1 : 0);
    }
    std::vector<std::size_t> kept = kept_vertices(ring, fixed, tolerance);
    drop_teeth(path, least_m2, kept);
    return kept;
}

/// The line through the middles of the path's edges from one vertex to another, each as much as it is long.
std::optional<Line2> fitted(const Path& path, std::size_t from, std::size_t to) {
    double sum = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    const std::size_t n = path.size(), edges = (to + n - from) % n;
    if (edges < 4) return std::nullopt;
    for (std::size_t k = 0; k < edges; ++k) {
        const Eigen::Vector2d &a = path[(from + k) % n].p, &b = path[(from + k + 1) % n].p;
        const double weight = (b - a).norm();
        const Eigen::Vector2d middle = 0.5 * (a + b) - path[from].p;
        sum += weight;
        mean += weight * middle;
        scatter += weight * middle * middle.transpose();
    }
    if (!(sum > 0)) return std::nullopt;
    mean /= sum;
    const Eigen::Matrix2d covariance = scatter / sum - mean * mean.transpose();
    const double angle = 0.5 * std::atan2(2 * covariance(0, 1), covariance(0, 0) - covariance(1, 1));
    return Line2{path[from].p + mean, {std::cos(angle), std::sin(angle)}};
}

/// The line of the edge between two vertices of a path: a meeting line that holds both, or the fitted one.
std::optional<Line2> line_of(const Path& path, std::size_t from, std::size_t to, const RingSnapper& snapper) {
    constexpr double kOn_m = 1e-6;
    const Vertex &a = path[from], &b = path[to];
    for (const int line : {a.line, b.line}) {
        if (line < 0) continue;
        const Line2& on = snapper.line(line);
        if (std::abs(on.offset(a.p)) < kOn_m && std::abs(on.offset(b.p)) < kOn_m) return on;
    }
    return fitted(path, from, to);
}

/// Where the lines before and after an edge cross, if they do within the reach of both its ends.
std::optional<Eigen::Vector2d> corner_near(const std::optional<Line2>& before,
                                           const std::optional<Line2>& after, const Eigen::Vector2d& from,
                                           const Eigen::Vector2d& to, double reach) {
    if (!before || !after) return std::nullopt;
    auto corner = crossing_of(*before, *after);
    if (!corner || (*corner - from).norm() > reach || (*corner - to).norm() > reach) return std::nullopt;
    return corner;
}

/// The corners of the path's straight edges. A short edge between two that cross there is a corner cut off by
/// the cells, and becomes one again.
Ring corners_of(const Path& path, const std::vector<std::size_t>& kept, const RingSnapper& snapper,
                double tolerance) {
    const std::size_t n = kept.size();
    const auto vertex = [&](std::size_t i) -> const Vertex& { return path[kept[i % n]]; };
    std::vector<std::optional<Line2>> lines;
    for (std::size_t i = 0; i < n; ++i) lines.push_back(line_of(path, kept[i], kept[(i + 1) % n], snapper));
    std::vector<std::optional<Eigen::Vector2d>> instead(n);  // of an edge, which begins at the vertex
    std::size_t left = n;
    for (std::size_t i = 0; i < n && left > 3; ++i) {
        if (instead[(i + n - 1) % n] || instead[(i + 1) % n]) continue;
        if (vertex(i).fixed && vertex(i + 1).fixed) continue;
        instead[i] = corner_near(lines[(i + n - 1) % n], lines[(i + 1) % n], vertex(i).p, vertex(i + 1).p,
                                 2 * tolerance);
        left -= instead[i].has_value();
    }
    Ring ring;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        if (instead[before]) continue;
        const Eigen::Vector2d& p = vertex(i).p;
        ring.push_back(instead[i] ? *instead[i]
                                  : corner_near(lines[before], lines[i], p, p, tolerance).value_or(p));
    }
    return ring;
}

Outline outline_of(const std::vector<Path>& paths, const RingSnapper& snapper, const EdgeRules& rules,
                   bool fit) {
    Outline outline;
    for (const Path& path : paths) {
        const std::vector<std::size_t> kept = kept_of(path, rules.tolerance_m, rules.least_m2);
        if (kept.size() < 3) continue;
        Ring ring;
        if (fit) {
            ring = corners_of(path, kept, snapper, rules.tolerance_m);
        } else {
            for (const std::size_t i : kept) ring.push_back(path[i].p);
        }
        if (signed_area(ring) != 0) outline.rings.push_back(std::move(ring));
    }
    return outline;
}

/// Outlines of the paths as simple as the rules allow without rings that cross; nothing if none is.
std::optional<Outline> simplest(const std::vector<Path>& paths, const RingSnapper& snapper, EdgeRules rules) {
    for (int attempt = 0; attempt < 4; ++attempt, rules.tolerance_m /= 2, rules.least_m2 /= 4) {
        for (const bool fit : {true, false}) {
            Outline outline = outline_of(paths, snapper, rules, fit);
            if (!rings_cross(outline)) return outline;
        }
    }
    return std::nullopt;
}

/// What a shape is like across a meeting line at one place, in steps of half a cell from the line.
struct Profile {
    int nearest_before = -1;                              ///< step of the shape's first cell; -1: none
    int cells_before = 0, cells_beyond = 0;               ///< steps that are in the shape
    bool goes_on_before = false, goes_on_beyond = false;  ///< past the reach
    bool certain_beyond = false;                          ///< a cell that must not be cut off

    bool goes_through() const { return goes_on_before && goes_on_beyond; }
    bool lies_beyond() const { return goes_on_beyond || (!goes_on_before && cells_beyond > cells_before); }
};

/// Calls visit(x, y) for the cell at each of so many steps from p.
template <typename Visit>
void for_steps(const Eigen::Vector2d& p, const Eigen::Vector2d& across, int from, int to,
               const Visit& visit) {
    for (int step = from; step <= to; ++step) {
        const Eigen::Vector2d at = p + 0.5 * (step + 0.5) * across;
        visit(step, static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
    }
}

Profile profile_at(const Bitmap& shape, const Bitmap& certain, const Eigen::Vector2d& p,
                   const Eigen::Vector2d& across, int reach) {
    constexpr int kPast = 4,
                  kBlurred = 2;  // steps past the reach; and at the line, where cells may be of either side
    Profile profile;
    for_steps(p, across, 0, reach + kPast, [&](int step, int x, int y) {
        if (!shape.at(x, y)) return;
        profile.goes_on_beyond = profile.goes_on_beyond || step > reach;
        profile.cells_beyond += step <= reach;
        profile.certain_beyond = profile.certain_beyond || (step >= kBlurred && certain.at(x, y));
    });
    for_steps(p, -across, 0, reach + kPast, [&](int step, int x, int y) {
        if (!shape.at(x, y)) return;
        profile.goes_on_before = profile.goes_on_before || step > reach;
        profile.cells_before += step <= reach;
        if (profile.nearest_before < 0 && step <= reach) profile.nearest_before = step;
    });
    return profile;
}

/// The shape along a meeting line, every half cell; `across` points to where the shape goes on least.
struct Place {
    Eigen::Vector2d p, across;
    Profile profile;
};

std::vector<Place> places_along(const Bitmap& shape, const Bitmap& certain, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& to, int reach) {
    std::vector<Place> places;
    const double length = (to - from).norm();
    if (!(length > 0)) return places;
    const Eigen::Vector2d along = (to - from) / length;
    for (double at = 0; at <= length; at += 0.5) {
        Place place{from + at * along, {-along.y(), along.x()}, {}};
        place.profile = profile_at(shape, certain, place.p, place.across, reach);
        if (place.profile.lies_beyond()) {
            place.across = -place.across;
            place.profile = profile_at(shape, certain, place.p, place.across, reach);
        }
        places.push_back(place);
    }
    return places;
}

}  // namespace

void end_at(const MeetingLine& line, double cell_m, const Bitmap& certain, Bitmap& shape) {
    const int reach = static_cast<int>(std::lround(2 * line.reach_m / cell_m));
    const std::vector<Place> places =
        places_along(shape, certain, line.from / cell_m, line.to / cell_m, reach);
    std::vector<int> kept{0};  // how many of the places before have something that must not be cut off
    for (const Place& place : places) kept.push_back(kept.back() + place.profile.certain_beyond);
    constexpr std::size_t kAround = 8;  // places to either side: what is cut and what is not are no teeth
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [p, across, profile] = places[i];
        if (profile.goes_through() || profile.nearest_before < 0) continue;
        const std::size_t first = i - std::min(i, kAround), last = std::min(i + kAround + 1, places.size());
        const bool cuts = 2 * (kept[last] - kept[first]) <= static_cast<int>(last - first);
        for_steps(p, across, -profile.nearest_before - 1, cuts ? reach : 0,
                  [&, &p = p, &across = across](int, int x, int y) {
                      const bool inside = across.dot(Eigen::Vector2d(x + 0.5, y + 0.5) - p) <= 0;
                      if (inside || cuts) shape.set(x, y, inside);
                  });
    }
}

Outline with_straight_edges(const Outline& traced, const std::vector<MeetingLine>& lines,
                            const EdgeRules& rules) {
    for (const bool on_lines : {true, false}) {
        if (on_lines && lines.empty()) continue;
        const RingSnapper snapper(on_lines ? lines : std::vector<MeetingLine>(), rules.cell_m);
        std::vector<Path> paths;
        for (const Ring& ring : traced.rings) paths.push_back(snapper.snapped(ring));
        if (auto outline = simplest(paths, snapper, rules)) return *outline;
    }
    return traced;
}

}  // namespace planemap::map
