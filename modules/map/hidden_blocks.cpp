// SPDX-License-Identifier: BSD-3-Clause
#include "map/hidden_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::map {

namespace {

constexpr int kTile = 10;  // blocks of a tile, along a side
/// The newest views that see something where a block is; more say the same.
constexpr int kMostAsked = 64;

}  // namespace

HiddenBlocks::HiddenBlocks(const Pose& world_from_raster, int plane_id, const BlockRange& range,
                           double block_m, const std::vector<OccludingView>& views, double range_m)
    : plane_id_(plane_id),
      range_(range),
      block_m_(block_m),
      range_m_(range_m),
      tiles_across_((range.width() + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(tiles_across_) *
             static_cast<std::size_t>((range.height() + kTile - 1) / kTile)),
      places_(static_cast<std::size_t>(range.width()) * static_cast<std::size_t>(range.height()),
              Place::kUnasked) {
    for (const OccludingView& view : views) {
        const Pose camera_from_raster = view.viewpoint->camera_from_world * world_from_raster;
        const auto& axes = camera_from_raster.linear();
        add_to_tiles({&view, camera_from_raster.translation(), axes.col(0), axes.col(1), axes.col(2)},
                     camera_from_raster);
    }
}

void HiddenBlocks::add_to_tiles(const Asked& asked, const Pose& camera_from_raster) {
    const Eigen::Vector3d camera = camera_from_raster.inverse(Eigen::Isometry).translation();
    if (std::abs(camera.z()) > range_m_) return;
    const double tile_m = kTile * block_m_, radius = std::sqrt(0.5) * tile_m;
    const double reach = std::sqrt(range_m_ * range_m_ - camera.z() * camera.z());
    const auto tile = [&](double at, int first, int count) {
        return static_cast<int>(
            std::clamp(std::floor((at - first * block_m_) / tile_m), -1.0, static_cast<double>(count)));
    };
    const int rows = static_cast<int>(tiles_.size()) / std::max(1, tiles_across_);
    const int x_from = std::max(0, tile(camera.x() - reach, range_.x0, tiles_across_)),
              x_to = std::min(tiles_across_ - 1, tile(camera.x() + reach, range_.x0, tiles_across_)),
              y_from = std::max(0, tile(camera.y() - reach, range_.y0, rows)),
              y_to = std::min(rows - 1, tile(camera.y() + reach, range_.y0, rows));
    const auto number = static_cast<std::uint32_t>(asked_.size());
    bool sees_any = false;
    for (int y = y_from; y <= y_to; ++y) {
        for (int x = x_from; x <= x_to; ++x) {
            const Eigen::Vector3d middle = asked.origin +
                                           (range_.x0 * block_m_ + (x + 0.5) * tile_m) * asked.x +
                                           (range_.y0 * block_m_ + (y + 0.5) * tile_m) * asked.y;
            if (!asked.view->viewpoint->keyframe->sight.may_hold(middle, radius)) continue;
            tiles_[tile_at(x, y)].push_back(number);
            sees_any = true;
        }
    }
    if (sees_any) asked_.push_back(asked);
}

HiddenBlocks::Place HiddenBlocks::at(int x, int y) {
    if (!range_.holds(x, y)) return Place::kUnknown;
    const int column = x - range_.x0, row = y - range_.y0;
    Place& place = places_[static_cast<std::size_t>(row) * static_cast<std::size_t>(range_.width()) +
                           static_cast<std::size_t>(column)];
    if (place == Place::kUnasked) {
        place =
            ask(block_m_ * Eigen::Vector2d(x + 0.5, y + 0.5), tiles_[tile_at(column / kTile, row / kTile)]);
    }
    return place;
}

HiddenBlocks::Place HiddenBlocks::ask(const Eigen::Vector2d& middle,
                                      const std::vector<std::uint32_t>& views) const {
    int looks = 0, before = 0, behind = 0;
    for (const std::uint32_t number : views) {
        const Asked& asked = asked_[number];
        const Viewpoint& viewpoint = *asked.view->viewpoint;
        const Eigen::Vector3d p = asked.origin + middle.x() * asked.x + middle.y() * asked.y;
        if (p.squaredNorm() > range_m_ * range_m_) continue;
        const std::uint8_t region = viewpoint.keyframe->sight.region_at(p);
        if (region == Sight::kNone) continue;
        const double depth = *viewpoint.seen().depth_behind(p);
        const std::optional<bool> is_past = past_.is_past(p, asked.normal, depth, viewpoint.keyframe->noise);
        if (!is_past) continue;
        if (*is_past) return Place::kOpen;
        if (++looks > kMostAsked) break;
        // From its other side, or where it is seen itself, nothing hides it.
        const bool is_its_own = asked.view->planes[region] == plane_id_;
        if (asked.normal.dot(p) >= 0 || is_its_own || asked.view->bounds[region] != 0) continue;
        ++(depth < p.z() ? before : behind);
    }
    return before > behind ? Place::kHidden : Place::kUnknown;
}

}  // namespace planemap::map
