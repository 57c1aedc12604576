// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "map/merging.hpp"
#include "map/plane_estimate.hpp"

namespace planemap::map {

/// Planes, none of which is the same plane as another by the merging rules, once merge() was called.
class PlaneSet {
  public:
    PlaneSet(const MergeRules& rules, double max_extent_m);

    /// Which planes are asked, by their index.
    using Asked = std::function<bool(std::size_t)>;
    /// The plane that a region fits best among those that satisfy the rules, and that are asked, or none().
    std::size_t partner_of(const PlacedRegion& region, const Asked& is_asked = nullptr) const;
    static constexpr std::size_t none() { return static_cast<std::size_t>(-1); }

    std::size_t push_back(PlaneEstimate estimate);
    void clear();
    /// After estimates()[i] changed.
    void update(std::size_t i);

    /// Merges, the best fit first, until no pair satisfies the rules; of pairs that did not before, only
    /// those with one of `grown` can. Returns for each plane where it is now; the older id stays.
    std::vector<std::size_t> merge(const std::vector<std::size_t>& grown);

    /// Lets planes without points go. Returns for each plane where it is now, or none().
    std::vector<std::size_t> drop_empty();

    /// How well two planes fit, the smaller the better, or nothing if they are not one.
    using Score = std::function<std::optional<double>(std::size_t a, std::size_t b)>;
    /// Told that one plane is part of another one now.
    using Joined = std::function<void(std::size_t into, std::size_t from)>;
    /// The same by another rule, of planes at no more than an angle that the rules' gap does not keep apart.
    std::vector<std::size_t> merge(const std::vector<std::size_t>& grown, double angle_rad,
                                   const Score& score, const Joined& joined);

    const MergeRules& rules() const { return rules_; }
    std::vector<PlaneEstimate>& estimates() { return estimates_; }
    const std::vector<PlaneEstimate>& estimates() const { return estimates_; }

  private:
    /// What most pairs fail on, side by side.
    struct Bounds {
        Eigen::Vector3d normal, low, high;
        double d;
    };
    static Bounds bounds_of(const PlaneEstimate& estimate);
    bool may_touch(const Bounds& a, const Bounds& b, double cosine) const;
    std::vector<std::size_t> keep(const std::vector<char>& is_kept);
    std::optional<RegionRelation> relation(const PlaneEstimate& a, const PlaneEstimate& b) const;

    MergeRules rules_;
    double cosine_;  ///< of the largest angle
    double max_extent_m_;
    std::vector<PlaneEstimate> estimates_;
    std::vector<Bounds> bounds_;
};

}  // namespace planemap::map
