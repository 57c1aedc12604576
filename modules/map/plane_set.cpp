// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_set.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "core/geometry/union_find.hpp"

namespace planemap::map {

PlaneSet::PlaneSet(const MergeRules& rules, double max_extent_m)
    : rules_(rules), cosine_(std::cos(rules.angle_rad)), max_extent_m_(max_extent_m) {}

PlaneSet::Bounds PlaneSet::bounds_of(const PlaneEstimate& estimate) {
    return {estimate.plane.normal, estimate.low, estimate.high, estimate.plane.d};
}

std::size_t PlaneSet::push_back(PlaneEstimate estimate) {
    bounds_.push_back(bounds_of(estimate));
    estimates_.push_back(std::move(estimate));
    return estimates_.size() - 1;
}

void PlaneSet::clear() {
    bounds_.clear();
    estimates_.clear();
}

void PlaneSet::update(std::size_t i) {
    bounds_[i] = bounds_of(estimates_[i]);
}

bool PlaneSet::may_touch(const Bounds& a, const Bounds& b, double cosine) const {
    if (a.normal.dot(b.normal) < cosine) return false;
    const double gap = rules_.gap_m + rules_.distance_m;
    return ((a.low.array() <= b.high.array() + gap) && (b.low.array() <= a.high.array() + gap)).all();
}

std::optional<RegionRelation> PlaneSet::relation(const PlaneEstimate& a, const PlaneEstimate& b) const {
    const double apart = (a.box.frame_from_box.translation() - b.box.frame_from_box.translation()).norm();
    if (apart + a.box.half_extents.norm() + b.box.half_extents.norm() > max_extent_m_) return std::nullopt;
    return same_plane(a.plane, a.box, b.plane, b.box, rules_);
}

std::size_t PlaneSet::partner_of(const PlacedRegion& region, const Asked& is_asked) const {
    const Eigen::Matrix3d& axes = region.box.frame_from_box.linear();
    const Eigen::Vector3d reach = axes.col(0).cwiseAbs() * region.box.half_extents.x() +
                                  axes.col(1).cwiseAbs() * region.box.half_extents.y();
    const Eigen::Vector3d center = region.box.frame_from_box.translation();
    const Bounds bounds{region.plane.normal, center - reach, center + reach, region.plane.d};
    std::size_t best = none();
    double best_score = 0;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        if (!may_touch(bounds, bounds_[i], cosine_) || (is_asked && !is_asked(i))) continue;
        const PlaneEstimate& estimate = estimates_[i];
        const double length = (center - estimate.box.frame_from_box.translation()).norm() +
                              region.box.half_extents.norm() + estimate.box.half_extents.norm();
        if (length > max_extent_m_) continue;
        const auto relation = same_plane(region.plane, region.box, estimate.plane, estimate.box, rules_);
        if (!relation) continue;
        const double score = relation->score(rules_);
        if (best == none() || score < best_score) {
            best = i;
            best_score = score;
        }
    }
    return best;
}

std::vector<std::size_t> PlaneSet::merge(const std::vector<std::size_t>& grown) {
    return merge(
        grown, rules_.angle_rad,
        [this](std::size_t a, std::size_t b) -> std::optional<double> {
            const auto r = relation(estimates_[a], estimates_[b]);
            return r ? std::optional(r->score(rules_)) : std::nullopt;
        },
        [](std::size_t, std::size_t) {});
}

std::vector<std::size_t> PlaneSet::merge(const std::vector<std::size_t>& grown, double angle_rad,
                                         const Score& score_of, const Joined& joined) {
    const double cosine = std::cos(angle_rad);
    // Pairs by score; a pair counts while neither of the two has changed.
    using Pair = std::tuple<double, std::size_t, std::size_t, int, int>;
    std::priority_queue<Pair, std::vector<Pair>, std::greater<>> pairs;
    std::vector<int> version(estimates_.size(), 0);
    UnionFind<std::size_t> merged(estimates_.size());
    std::vector<char> asked(estimates_.size(), 0);
    const auto ask = [&](std::size_t i) {
        for (std::size_t j = 0; j < estimates_.size(); ++j) {
            if (j == i || !merged.stands(j) || asked[j] != 0 || !may_touch(bounds_[i], bounds_[j], cosine))
                continue;
            const auto [a, b] = std::minmax(i, j);
            if (const auto score = score_of(a, b)) pairs.emplace(*score, a, b, version[a], version[b]);
        }
    };
    for (const std::size_t i : grown) {
        ask(i);
        asked[i] = 1;  // its pairs are known
    }
    asked.assign(estimates_.size(), 0);
    while (!pairs.empty()) {
        const auto [score, a, b, version_a, version_b] = pairs.top();
        pairs.pop();
        if (!merged.stands(a) || !merged.stands(b) || version[a] != version_a || version[b] != version_b)
            continue;
        const int id = std::min(estimates_[a].id, estimates_[b].id);
        estimates_[a].absorb(estimates_[b]);
        estimates_[a].id = id;
        update(a);
        merged.join(a, b);
        joined(a, b);
        ++version[a];
        ask(a);
    }

    std::vector<char> is_kept(estimates_.size());
    for (std::size_t i = 0; i < is_kept.size(); ++i) is_kept[i] = merged.stands(i);
    std::vector<std::size_t> now = keep(is_kept);
    for (std::size_t i = 0; i < now.size(); ++i)
        if (!merged.stands(i)) now[i] = now[merged.find(i)];
    return now;
}

std::vector<std::size_t> PlaneSet::drop_empty() {
    std::vector<char> is_kept(estimates_.size());
    std::transform(estimates_.begin(), estimates_.end(), is_kept.begin(),
                   [](const PlaneEstimate& plane) { return plane.moments.count > 0; });
    return keep(is_kept);
}

/// Closes the gaps that the others leave; returns for each where it is now, or none().
std::vector<std::size_t> PlaneSet::keep(const std::vector<char>& is_kept) {
    std::vector<std::size_t> now(estimates_.size(), none());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
        if (is_kept[i] == 0) continue;
        now[i] = kept;
        if (kept != i) {
            estimates_[kept] = std::move(estimates_[i]);
            bounds_[kept] = bounds_[i];
        }
        ++kept;
    }
    estimates_.resize(kept);
    bounds_.resize(kept);
    return now;
}

}  // namespace planemap::map
