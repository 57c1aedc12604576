// SPDX-License-Identifier: BSD-3-Clause
#include "map/inference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace planemap::map {

namespace {

/// Nobody may know so much between what hides a plane and what is seen of it: regions end before their edges.
constexpr double kUnknown_m = 0.15;
/// A plane may be come to so far beyond the box of its outline.
constexpr double kBeside_m = 0.5;

/// Bits beside which, to the side (dx, dy), none is set.
std::uint64_t edge_bits(const Bitmap& cells, int y, int w, int dx, int dy) {
    const std::uint64_t* row = cells.row(y);
    const auto word = [&](int at) { return at >= 0 && at < cells.words() ? row[at] : 0; };
    if (dx > 0) return row[w] & ~(row[w] >> 1 | word(w + 1) << 63);
    if (dx < 0) return row[w] & ~(row[w] << 1 | word(w - 1) >> 63);
    const int beside = y + dy;
    if (beside < cells.y0() || beside >= cells.y0() + cells.rows()) return row[w];
    return row[w] & ~cells.row(beside)[w];
}

/// f(x, y) for each bit of a word.
template <typename F>
void for_each_bit(std::uint64_t bits, int word, int y, const F& f) {
    for (int x = 64 * word; bits != 0; ++x, bits >>= 1)
        if ((bits & 1) != 0) f(x, y);
}

template <typename F>
void for_each_cell(const Bitmap& cells, const F& f) {
    for (int y = cells.y0(); y < cells.y0() + cells.rows(); ++y)
        for (int w = 0; w < cells.words(); ++w) for_each_bit(cells.row(y)[w], cells.word0() + w, y, f);
}

}  // namespace

Inference::Inference(const PlaneMap& map, const std::vector<Viewpoint>& views,
                     const std::map<int, PlanePart>& told, double cell_m)
    : cell_m_(cell_m) {
    if (views.empty() && told.empty()) return;
    shapes_ = bound_shapes(map, cell_m_);
    take_views(map, views);
    double range = 0;  // as far as the sensor sees
    for (const Viewpoint& view : views) range = std::max(range, view.keyframe->sight.reach());
    for (const BoundShape& shape : shapes_) {
        Hidden& hidden = hidden_.emplace_back(
            Hidden{{shape.world_from_raster, shape.id, shape.range, kCellsOfBlock * cell_m_, views_, range},
                   shape.no_cells(),
                   shape.no_cells(),
                   {}});
        const auto before = told.find(shape.id);
        if (before == told.end()) continue;
        draw(before->second.outline, shape.raster_from_world * before->second.world_from_frame, cell_m_,
             hidden.told);
    }
}

/// Which planes the regions of all views are part of.
void Inference::take_views(const PlaneMap& map, const std::vector<Viewpoint>& views) {
    views_.reserve(views.size());
    for (const Viewpoint& view : views) {
        OccludingView& occluding = views_.emplace_back();
        occluding.viewpoint = &view;
        const StoredKeyframe& keyframe = *view.keyframe;
        for (std::size_t i = 0; i < view.planes.size(); ++i) {
            // Of one whose regions went elsewhere nobody knows what they are: they hide nothing.
            const bool is_known = keyframe.sight_planes.empty();
            const int id = is_known ? keyframe.regions[i].plane : -1;
            const MapPlane* plane = map.find(id);
            occluding.planes.push_back(id);
            occluding.bounds.push_back(!is_known || (plane != nullptr && is_bound(plane->label)) ? 1 : 0);
        }
    }
}

std::map<int, InferredCells> Inference::infer() {
    std::map<int, InferredCells> inferred;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
            follow(i, dx, dy);
        InferredCells cells = result(i);
        if (cells.cells.count() > 0) inferred.emplace(shapes_[i].id, std::move(cells));
    }
    return inferred;
}

/// From all edges of an outline to one side.
void Inference::follow(std::size_t index, int dx, int dy) {
    const Bitmap& seen = shapes_[index].seen;
    const Eigen::Vector2d step = cell_m_ * Eigen::Vector2d(dx, dy);
    std::vector<Cell> path;
    const auto follow_from = [&](int x, int y) {
        path.clear();
        if (walk(index, cell_m_ * Eigen::Vector2d(x + 0.5, y + 0.5), step, true, path) == End::kNowhere)
            return;
        for (const Cell& cell : path) hidden_[index].inferred.set(cell.x, cell.y, true);
    };
    for (int y = seen.y0(); y < seen.y0() + seen.rows(); ++y)
        for (int w = 0; w < seen.words(); ++w)
            for_each_bit(edge_bits(seen, y, w, dx, dy), seen.word0() + w, y, follow_from);
}

/// Follows a shape step by step; `path` has the cells on the way that are not seen.
Inference::End Inference::walk(std::size_t index, Eigen::Vector2d p, const Eigen::Vector2d& step,
                               bool to_lines, std::vector<Cell>& path) {
    const BoundShape& shape = shapes_[index];
    Hidden& hidden = hidden_[index];
    const int most_unknown = static_cast<int>(kUnknown_m / cell_m_);
    int unknown = 0;
    bool is_hidden = false;
    for (;;) {
        const Eigen::Vector2d next = p + step;
        if (const auto end = end_between(index, p, next, to_lines && is_hidden)) return *end;
        p = next;
        const Cell cell{static_cast<int>(std::floor(p.x() / cell_m_)),
                        static_cast<int>(std::floor(p.y() / cell_m_))};
        if (shape.seen.at(cell.x, cell.y)) return is_hidden || !to_lines ? End::kSeen : End::kNowhere;
        const int x = cell.x >> 2, y = cell.y >> 2;
        static_assert(kCellsOfBlock == 4);
        if (!shape.range.holds(x, y)) return End::kNowhere;
        const HiddenBlocks::Place place = hidden.blocks.at(x, y);
        if (place == HiddenBlocks::Place::kOpen) return End::kNowhere;
        if (place == HiddenBlocks::Place::kHidden || hidden.told.at(cell.x, cell.y)) {
            unknown = 0;
            is_hidden = true;
        } else if (++unknown > most_unknown) {
            return End::kNowhere;
        }
        path.push_back(cell);
    }
}

/// Where a step leads to the line with another plane; nothing if it does not.
std::optional<Inference::End> Inference::end_between(std::size_t index, const Eigen::Vector2d& p,
                                                     const Eigen::Vector2d& next, bool to_lines) {
    const BoundShape& shape = shapes_[index];
    for (std::size_t i = 0; i < shape.before.size(); ++i) {
        const HalfPlane& before = shape.before[i];
        const double from = before.inside(p), to = before.inside(next);
        if (!(from > 0 && to <= 0)) continue;
        const BoundShape& other = shapes_[before.other];
        const Eigen::Vector2d at = p + from / (from - to) * (next - p);
        const Eigen::Vector3d at_world = shape.world_from_raster * Eigen::Vector3d(at.x(), at.y(), 0);
        const Eigen::Array2d on_other = (other.raster_from_world * at_world).head<2>();
        if ((on_other < other.low.array() - kBeside_m).any() ||
            (on_other > other.high.array() + kBeside_m).any())
            continue;  // it is not here
        if (!to_lines || !comes_to_seen(before.other, at_world, shape.plane.normal)) return End::kNowhere;
        const double along = Eigen::Vector2d(-before.normal.y(), before.normal.x()).dot(at);
        const auto [ends, is_new] = hidden_[index].ends.try_emplace(i, along, along);
        ends->second.first = std::min(ends->second.first, along);
        ends->second.second = std::max(ends->second.second, along);
        return End::kLine;
    }
    return std::nullopt;
}

/// Whether a shape, followed from a point on it into a direction, is seen there or behind what hides it.
bool Inference::comes_to_seen(std::size_t index, const Eigen::Vector3d& p_world,
                              const Eigen::Vector3d& away) {
    const BoundShape& shape = shapes_[index];
    const Eigen::Vector2d p = (shape.raster_from_world * p_world).head<2>();
    const Eigen::Vector2d step = cell_m_ * (shape.raster_from_world.linear() * away).head<2>().normalized();
    std::vector<Cell> path;
    return walk(index, p, step, false, path) == End::kSeen;
}

/// With hidden slits, without slivers.
InferredCells Inference::result(std::size_t index) {
    constexpr int kSlit = 4, kSliver = 2;  // narrower than 9 and 5 cells
    const BoundShape& shape = shapes_[index];
    Hidden& hidden = hidden_[index];
    Bitmap all = hidden.inferred;
    all |= shape.seen;
    Bitmap cells = all.closed(kSlit);
    cells -= shape.seen;
    Bitmap slits = cells;
    slits -= hidden.inferred;
    for_each_cell(slits, [&](int x, int y) {
        if (hidden.blocks.at(x >> 2, y >> 2) != HiddenBlocks::Place::kHidden) cells.set(x, y, false);
    });
    InferredCells result{shape.world_from_raster, cell_m_, cells.opened(kSliver), {}};
    for (const auto& [i, ends] : hidden.ends) {
        const HalfPlane& before = shape.before[i];
        const Eigen::Vector2d foot = -before.offset * before.normal,
                              along(-before.normal.y(), before.normal.x());
        result.lines.push_back(
            {foot + (ends.first - cell_m_) * along, foot + (ends.second + cell_m_) * along, cell_m_});
    }
    return result;
}

}  // namespace planemap::map
