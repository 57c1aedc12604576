// SPDX-License-Identifier: BSD-3-Clause
#include "map/belonging.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace planemap::map {

namespace {

constexpr int kMostRounds = 4;
constexpr double kBetter = 0.5;  // of a region's distance: a plane as near as this is the better one for it

class Reassignment {
  public:
    Reassignment(PlaneSet& planes, std::vector<SeenRegion>& seen, const std::vector<std::size_t>& order,
                 std::size_t fixed, RegionJoiner& joiner, const SurfaceRules& rules)
        : planes_(planes),
          seen_(seen),
          order_(order),
          fixed_(fixed),
          joiner_(joiner),
          rules_(rules),
          cosine_(std::cos(planes.rules().angle_rad)),
          least_apart_m_(planes.rules().distance_m),
          most_apart_m_(std::max(least_apart_m_, rules.most_apart_m)),
          now_(planes.estimates().size()) {
        std::iota(now_.begin(), now_.end(), std::size_t{0});
    }

    std::vector<std::size_t> run() {
        for (int round = 0; round < kMostRounds; ++round) {
            const std::vector<Stray> strays = find_strays();
            if (strays.empty()) break;
            move(strays);
        }
        return now_;
    }

  private:
    struct Stray {
        std::size_t entry;  ///< of seen_
        std::size_t to;
    };

    Observation observation(std::size_t entry) const {
        return Observation(*seen_[entry].keyframe, seen_[entry].stored());
    }

    /// RMS over the region's points.
    static double distance(const PlacedRegion& placed, const PlaneEstimate& plane) {
        return std::sqrt(misfit2(placed, plane.plane));
    }

    bool is_within(const PlacedRegion& placed, const PlaneEstimate& plane, double most_m) const {
        return placed.plane.normal.dot(plane.plane.normal) >= cosine_ && distance(placed, plane) <= most_m;
    }

    /// How far poses and depth may put a region off its plane.
    double band(const Observation& seen) const {
        const double z = mean_depth(seen.region), sigma = seen.keyframe.noise.sigma(z);
        const double error = rules_.sigmas * std::hypot(rules_.pose_sigma_m, sigma) + rules_.range_bias * z;
        return std::clamp(error, least_apart_m_, most_apart_m_);
    }

    std::vector<Stray> find_strays() const {
        std::vector<Stray> strays;
        for (const std::size_t i : order_) {
            const std::size_t own = seen_[i].plane;
            if (own == PlaneSet::none() || own < fixed_) continue;
            const Observation seen = observation(i);
            const PlaneEstimate& plane = planes_.estimates()[own];
            const double most = band(seen), off = distance(seen.placed, plane);
            const bool belongs = is_within(seen.placed, plane, most);
            if (belongs && off <= joiner_.model().reliability(seen.region, seen.keyframe.noise).sigma_m)
                continue;
            const double nearer = belongs ? kBetter * off : most;
            const std::size_t to = planes_.partner_of(seen.placed, [&](std::size_t at) {
                return at != own && is_within(seen.placed, planes_.estimates()[at], nearer);
            });
            if (to != PlaneSet::none()) strays.push_back({i, to});
        }
        return strays;
    }

    void move(const std::vector<Stray>& strays) {
        std::vector<char> has_lost(planes_.estimates().size(), 0);
        for (const Stray& stray : strays) {
            has_lost[seen_[stray.entry].plane] = 1;
            seen_[stray.entry].plane = PlaneSet::none();
        }
        make_anew(has_lost);
        std::vector<char> has_changed = has_lost;
        for (const auto& [entry, to] : strays) {
            joiner_.join(planes_, to, planes_.estimates()[to].id, observation(entry));
            seen_[entry].plane = to;
            has_changed[to] = 1;
        }
        std::vector<std::size_t> changed;
        for (std::size_t i = 0; i < has_changed.size(); ++i) {
            PlaneEstimate& plane = planes_.estimates()[i];
            if (has_changed[i] == 0 || plane.moments.count <= 0) continue;
            plane.refit();
            planes_.update(i);
            changed.push_back(i);
        }
        follow(planes_.drop_empty(), changed);
        follow(planes_.merge(changed), changed);
    }

    /// Planes that lost regions, of those that are left.
    void make_anew(const std::vector<char>& has_lost) {
        for (std::size_t i = 0; i < has_lost.size(); ++i)
            if (has_lost[i] != 0) planes_.estimates()[i] = planes_.estimates()[i].emptied();
        for (const std::size_t i : order_) {
            const std::size_t plane = seen_[i].plane;
            if (plane == PlaneSet::none() || has_lost[plane] == 0) continue;
            joiner_.join(planes_, plane, planes_.estimates()[plane].id, observation(i));
        }
    }

    /// Planes are elsewhere in the list.
    void follow(const std::vector<std::size_t>& now, std::vector<std::size_t>& changed) {
        const auto moved = [&](std::size_t& plane) {
            if (plane != PlaneSet::none()) plane = now[plane];
        };
        for (SeenRegion& region : seen_) moved(region.plane);
        for (std::size_t& plane : now_) moved(plane);
        for (std::size_t& plane : changed) moved(plane);
    }

    PlaneSet& planes_;
    std::vector<SeenRegion>& seen_;
    const std::vector<std::size_t>& order_;
    std::size_t fixed_;
    RegionJoiner& joiner_;
    SurfaceRules rules_;
    double cosine_, least_apart_m_, most_apart_m_;
    std::vector<std::size_t> now_;
};

}  // namespace

std::vector<std::size_t> reassign_strays(PlaneSet& planes, std::vector<SeenRegion>& seen,
                                         const std::vector<std::size_t>& order, std::size_t fixed,
                                         RegionJoiner& joiner, const SurfaceRules& rules) {
    return Reassignment(planes, seen, order, fixed, joiner, rules).run();
}

}  // namespace planemap::map
