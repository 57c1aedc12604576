// SPDX-License-Identifier: BSD-3-Clause
// Space that views saw to be empty: what lies before the regions that they see.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "core/seen_space.hpp"
#include "map/free_space.hpp"

namespace planemap::map {

/// Collects what views saw through. A voxel is free when the middle of it lies before the region that a view
/// sees there by more than margin_m across the region, two sigma of the sensor's noise and one per cent of
/// the range (PastRules); farther than 15 m, and where no region fills the coarse cell of the view, it says
/// nothing. A block is asked no more when 16 views in all saw nothing new of it, so the work grows with the
/// space; of blocks beyond SeenSpace::kMostBlocks the last ones are left out.
class SeenThrough {
  public:
    explicit SeenThrough(double margin_m) { rules_.margin_m = margin_m; }

    /// What is known already; call it first.
    void start_from(const SeenSpace& before);
    void look(const Viewpoint& view);
    SeenSpace space() const;

    std::size_t memory_bytes() const;

  private:
    using At = std::array<std::int16_t, 3>;
    struct LookedAt {
        SeenSpace::Block block;
        int in_vain = 0;
    };

    LookedAt* looked_at(const At& at);
    bool see_through(const Viewpoint& view, const Eigen::Vector3d& corner_camera,
                     SeenSpace::Block& block) const;
    bool is_before_region(const Viewpoint& view, const Eigen::Vector3d& p_camera) const;

    PastRules rules_;
    std::vector<LookedAt> blocks_;
    std::unordered_map<std::uint64_t, std::size_t> index_;  ///< of blocks_, by where they are
};

/// What views saw through besides what is known already. So many that there is no time for all are looked at
/// spread evenly: `goes_on` is asked before each, and when it says no, space that only others saw is left
/// unknown. Empty: all of them.
SeenSpace seen_through(SeenThrough known, const std::vector<Viewpoint>& views,
                       const std::function<bool()>& goes_on = {});

}  // namespace planemap::map
