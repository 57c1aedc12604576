// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap {

/// An outline's edges by bands of y, for questions in great number: the same answers as
/// core/geometry/outline's, each from the edges of one band or a few.
class OutlineIndex {
  public:
    explicit OutlineIndex(const Outline& outline);

    /// contains(outline, p).
    bool contains(const Eigen::Vector2d& p) const;
    /// The outline's rings that hold the point, ascending.
    std::vector<std::size_t> rings_around(const Eigen::Vector2d& p) const;
    /// distance(outline, p) if it is not above `reach`, else infinity.
    double distance_within(const Eigen::Vector2d& p, double reach) const;
    /// Where the line of that y crosses the edges, in no order: p is inside if an odd number of them are
    /// greater than its x.
    void crossings(double y, std::vector<double>& xs) const;
    /// Edges that these have looked at so far.
    std::size_t work() const { return work_; }

  private:
    struct Edge {
        Eigen::Vector2d a, b;
        std::size_t ring;
    };
    std::size_t band(double y) const;
    template <typename Visit>
    void for_edges_beyond(const Eigen::Vector2d& p, Visit visit) const;

    std::vector<Edge> edges_;
    double y_min_ = 0, bands_per_metre_ = 0;
    std::vector<std::uint32_t> starts_;  ///< of each band in members_, and the end of the last
    std::vector<std::uint32_t> members_;
    mutable std::size_t work_ = 0;
};

}  // namespace planemap
