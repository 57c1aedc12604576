// SPDX-License-Identifier: BSD-3-Clause
#include "run/coverage.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/geometry/outline_index.hpp"
#include "core/geometry/parity.hpp"
#include "octomap/voxel_set.hpp"

namespace planemap {

namespace {

/// Leaf centres in cubes of 32 leaves, so that a plane is compared with those near it only.
class LeafCubes {
  public:
    LeafCubes(const std::vector<Eigen::Vector3d>& leaves, double leaf_m) : leaves_(leaves) {
        std::map<std::tuple<double, double, double>, Cube> cubes;
        Eigen::Vector3d last_at = Eigen::Vector3d::Constant(std::nan(""));
        Cube* last = nullptr;  // leaves come in the tree's order: the next one is mostly in the same cube
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            if (!leaves[i].allFinite()) continue;
            const Eigen::Vector3d at = (leaves[i] / (32 * leaf_m)).array().floor();
            if (at != last_at) last = &cubes[{at.x(), at.y(), at.z()}];
            last_at = at;
            last->low = last->leaves.empty() ? leaves[i] : last->low.cwiseMin(leaves[i]);
            last->high = last->leaves.empty() ? leaves[i] : last->high.cwiseMax(leaves[i]);
            last->leaves.push_back(i);
        }
        for (auto& [at, cube] : cubes) cubes_.push_back(std::move(cube));
    }

    /// Indices of the leaves that may lie within `reach` of the region: at least those that do.
    void find_near(const PlanarRegion& region, double reach, std::vector<std::size_t>& near) const {
        near.clear();
        const Pose& frame = region.box.frame_from_box;
        const Eigen::Vector3d center = frame.translation(), normal = frame.linear().col(2);
        const double radius = outer_radius(region) + reach;
        for (const Cube& cube : cubes_) {
            const Eigen::Vector3d middle = 0.5 * (cube.low + cube.high), half = cube.high - middle;
            // What rounding may add: the coordinates' own precision, amply.
            const double margin = 1e-6 * (reach + radius + middle.norm());
            const double thick = half.dot(normal.cwiseAbs()) + reach + margin;
            if (std::abs((middle - center).dot(normal)) > thick) continue;
            if ((middle - center).norm() > radius + half.norm() + margin) continue;
            for (const std::size_t i : cube.leaves) {
                if (std::abs((leaves_[i] - center).dot(normal)) <= reach + margin) near.push_back(i);
            }
        }
    }

  private:
    struct Cube {
        Eigen::Vector3d low, high;
        std::vector<std::size_t> leaves;
    };
    /// Of a circle about the box's origin that holds box and outline.
    static double outer_radius(const PlanarRegion& region) {
        double radius = region.box.half_extents.norm();
        for (const Ring& ring : region.outline.rings) {
            for (const Eigen::Vector2d& v : ring) radius = std::max(radius, v.norm());
        }
        return radius;
    }

    const std::vector<Eigen::Vector3d>& leaves_;
    std::vector<Cube> cubes_;
};

/// The samples of a plane's area: a raster in the x and y of its box, with its middle in the box's.
struct Raster {
    double step;
    int columns, rows;

    Raster(const Box& box, double sample_step)
        // Two cells of margin, because a simplified outline may reach out of the box a little.
        : step(sample_step),
          columns(static_cast<int>(std::ceil(2 * box.half_extents.x() / step)) + 4),
          rows(static_cast<int>(std::ceil(2 * box.half_extents.y() / step)) + 4) {}

    double x(int column) const { return step * (column - 0.5 * (columns - 1)); }
    double y(int row) const { return step * (row - 0.5 * (rows - 1)); }
    /// The first column whose x is not below the given one; `columns` if there is none.
    int first_column(double from) const {
        const double guess = std::ceil(from / step + 0.5 * (columns - 1));
        int column = static_cast<int>(std::clamp(guess, 0.0, static_cast<double>(columns)));
        while (column > 0 && x(column - 1) >= from) --column;
        while (column < columns && x(column) < from) ++column;
        return column;
    }
    int first_row(double from) const {
        const double guess = std::ceil(from / step + 0.5 * (rows - 1)) - 1;
        return static_cast<int>(std::clamp(guess, 0.0, static_cast<double>(rows)));
    }
};

/// One row of a raster: which of its samples lie inside an outline.
class RowInside {
  public:
    /// xs: where the row's line crosses the outline's edges. Their order is changed.
    void assign(const Raster& raster, std::vector<double>& xs) {
        // A sample is inside if an odd number of crossings, of an even number in all, are greater than its x:
        // between the first and the second, the third and the fourth, and so on.
        const std::size_t words = static_cast<std::size_t>(raster.columns) / 64 + 1;
        as_bits_ = xs.size() > words;
        if (as_bits_) return assign_bits(raster, xs, words);
        std::sort(xs.begin(), xs.end());
        spans_.clear();
        for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
            const int from = raster.first_column(xs[i]), to = raster.first_column(xs[i + 1]);
            if (from < to) spans_.emplace_back(from, to);
        }
    }
    std::size_t count() const {
        std::size_t count = 0;
        if (as_bits_) {
            for (const std::uint64_t word : bits_) count += static_cast<std::size_t>(std::popcount(word));
        } else {
            for (const auto& [from, to] : spans_) count += static_cast<std::size_t>(to - from);
        }
        return count;
    }
    bool contains(int column) const {
        if (as_bits_) return (bits_[static_cast<std::size_t>(column) / 64] >> (column % 64) & 1) != 0;
        const auto after = std::upper_bound(spans_.begin(), spans_.end(), column,
                                            [](int c, const auto& span) { return c < span.first; });
        return after != spans_.begin() && column < std::prev(after)->second;
    }

  private:
    /// With more crossings than words, flipping bits is less work than sorting.
    void assign_bits(const Raster& raster, const std::vector<double>& xs, std::size_t words) {
        bits_.assign(words, 0);
        for (const double x : xs) {
            const auto column = static_cast<std::size_t>(raster.first_column(x));
            bits_[column / 64] ^= std::uint64_t{1} << (column % 64);
        }
        set_between_flips(bits_);
        // No sample lies behind the last column.
        if (raster.columns % 64 != 0)
            bits_.back() &= (std::uint64_t{1} << (raster.columns % 64)) - 1;
        else
            bits_.back() = 0;
    }

    bool as_bits_ = false;
    std::vector<std::pair<int, int>> spans_;  ///< columns [from, to)
    std::vector<std::uint64_t> bits_;
};

/// How far each leaf is from the nearest outline of the planes that were added, up to a leaf's size.
class LeafDistances {
  public:
    LeafDistances(const std::vector<Eigen::Vector3d>& leaves, double leaf_m)
        : leaves_(leaves), reach_m_(leaf_m), cubes_(leaves, leaf_m), apart_m_(leaves.size(), kFar) {}

    /// Returns the leaves that may lie within reach of it: valid until the next one.
    const std::vector<std::size_t>& add(const PlanarRegion& region, const OutlineIndex& outline) {
        cubes_.find_near(region, reach_m_, near_);
        for (const std::size_t i : near_)
            apart_m_[i] = std::min(apart_m_[i], distance_to(region, outline, leaves_[i]));
        return near_;
    }

    /// Of a leaf to the nearest outline, metres; infinite beyond the reach.
    const std::vector<double>& apart_m() const { return apart_m_; }

  private:
    static constexpr double kFar = std::numeric_limits<double>::infinity();

    double distance_to(const PlanarRegion& region, const OutlineIndex& outline,
                       const Eigen::Vector3d& p) const {
        // Cheap tests before the outline: the plane, then a circle around the box.
        const double off = region.plane.signed_distance(p);
        if (std::abs(off) > reach_m_) return kFar;
        const double apart = (p - region.box.frame_from_box.translation()).norm();
        if (apart > region.box.half_extents.norm() + 2 * reach_m_) return kFar;
        if (region.outline.empty()) return distance(region, p);
        const Eigen::Vector3d q = region.box.frame_from_box.inverse(Eigen::Isometry) * p;
        return std::hypot(outline.distance_within(q.head<2>(), reach_m_), off);
    }

    const std::vector<Eigen::Vector3d>& leaves_;
    double reach_m_;
    LeafCubes cubes_;
    std::vector<double> apart_m_;
    std::vector<std::size_t> near_;  ///< of the plane at hand
};

/// Compares one plane after the other with the leaves.
class Comparison {
  public:
    Comparison(const std::vector<Eigen::Vector3d>& leaves, double leaf_m)
        : leaves_(leaves), leaf_m_(leaf_m), distances_(leaves, leaf_m) {}

    void add(const PlanarRegion& region) {
        const OutlineIndex outline(region.outline);
        const std::vector<std::size_t>& near = distances_.add(region, outline);
        const Raster raster(region.box, leaf_m_ / 2);
        find_supported(region.box, near, raster);
        count_samples(outline, raster);
    }

    Coverage coverage() const {
        Coverage coverage;
        if (!leaves_.empty()) {
            coverage.leaves_explained = share_within(leaf_m_);
            coverage.leaves_explained_half = share_within(leaf_m_ / 2);
        }
        if (samples_ > 0)
            coverage.area_supported = static_cast<double>(supported_) / static_cast<double>(samples_);
        return coverage;
    }

  private:
    double share_within(double reach_m) const {
        const std::vector<double>& apart = distances_.apart_m();
        const auto count =
            std::count_if(apart.begin(), apart.end(), [&](double apart_m) { return apart_m <= reach_m; });
        return static_cast<double>(count) / static_cast<double>(leaves_.size());
    }

    /// The samples within one leaf size of one of the leaves near the plane, row by row.
    void find_supported(const Box& box, const std::vector<std::size_t>& near, const Raster& raster) {
        touched_.clear();
        const Pose box_from_frame = box.frame_from_box.inverse(Eigen::Isometry);
        for (const std::size_t i : near) {
            const Eigen::Vector3d q = box_from_frame * leaves_[i];
            const double reach = leaf_m_ * (1 + 1e-6);
            const int last_row = std::min(raster.first_row(q.y() + reach) + 1, raster.rows - 1);
            const int last_column = std::min(raster.first_column(q.x() + reach), raster.columns - 1);
            const int first_column = raster.first_column(q.x() - reach);
            for (int row = raster.first_row(q.y() - reach); row <= last_row; ++row) {
                for (int column = first_column; column <= last_column; ++column) {
                    const Eigen::Vector3d p =
                        box.frame_from_box * Eigen::Vector3d(raster.x(column), raster.y(row), 0);
                    if ((p - leaves_[i]).norm() <= leaf_m_) touched_.insert({column, row / 8, row % 8});
                }
            }
        }
        supported_samples_.clear();
        touched_.for_each(
            [&](const octomap::Voxel& v) { supported_samples_.emplace_back(8 * v.y + v.z, v.x); });
        std::sort(supported_samples_.begin(), supported_samples_.end());
    }

    void count_samples(const OutlineIndex& outline, const Raster& raster) {
        auto sample = supported_samples_.begin();
        for (int row = 0; row < raster.rows; ++row) {
            outline.crossings(raster.y(row), crossings_);
            inside_.assign(raster, crossings_);
            samples_ += inside_.count();
            for (; sample != supported_samples_.end() && sample->first == row; ++sample)
                supported_ += inside_.contains(sample->second);
        }
    }

    const std::vector<Eigen::Vector3d>& leaves_;
    double leaf_m_;
    LeafDistances distances_;
    std::size_t samples_ = 0, supported_ = 0;
    // Of the plane at hand.
    octomap::VoxelSet touched_;                           ///< column, row / 8, row % 8
    std::vector<std::pair<int, int>> supported_samples_;  ///< row, column
    std::vector<double> crossings_;
    RowInside inside_;
};

}  // namespace

Coverage coverage_of(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves, double leaf_m) {
    Comparison comparison(leaves, leaf_m);
    for (const MapPlane& plane : map.planes) comparison.add(plane.region());
    return comparison.coverage();
}

std::vector<Eigen::Vector3d> explained_leaves(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves,
                                              double leaf_m) {
    LeafDistances distances(leaves, leaf_m);
    for (const MapPlane& plane : map.planes) {
        const PlanarRegion region = plane.region();
        distances.add(region, OutlineIndex(region.outline));
    }
    std::vector<Eigen::Vector3d> explained;
    for (std::size_t i = 0; i < leaves.size(); ++i)
        if (distances.apart_m()[i] <= leaf_m) explained.push_back(leaves[i]);
    return explained;
}

}  // namespace planemap
