// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/merging.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace planemap::segmentation {

namespace {

/// How far the worse of two regions would leave their common plane, as a share of what is allowed.
double merge_cost(const MergeRules& rules, const std::vector<MergeRegion>& regions, const Touch& touch) {
    const MergeRegion &a = regions[touch.a - 1], &b = regions[touch.b - 1];
    constexpr double kNever = 2;
    if (!a.fit.valid || !b.fit.valid) return kNever;
    PointSums sums = a.sums;
    sums += b.sums;
    const InverseDepthFit joint = sums.fit();
    if (!joint.valid) return kNever;
    // Where the cells at the common border continue each other there is no step, and what is left of a gap is
    // the sensor's distortion; where nothing is known about the border only a much better fit will do.
    const bool continuous = 2 * touch.linked > touch.side_by_side;
    const double strictness = continuous ? 1 : 0.5;
    double worst = 0, angle = rules.angle_rad;
    for (const MergeRegion* part : {&a, &b}) {
        const double z = 1 / part->fit.w, sigma = rules.noise.sigma(z);
        const double limit = strictness * std::max(rules.merge_m, rules.merge_sigmas * sigma);
        const double excess = std::max(0.0, part->fit.mse_to(joint.plane) - part->fit.mse);
        worst = std::max(worst, distance_of(std::sqrt(excess), z, joint.plane) / limit);
        // The normal of a small far region is uncertain.
        angle += sigma / z / (rules.cell_x * std::sqrt(part->cells) * 0.5 * part->cells);
    }
    return a.fit.plane.cosine(b.fit.plane) >= std::cos(std::min(angle, 1.0)) ? worst : kNever;
}

}  // namespace

double distance_of(double inverse_depth, double z, const InverseDepthPlane& plane) {
    return std::abs(inverse_depth) * z / plane.steepness();
}

void TouchList::clear() {
    entries_.clear();
    recent_.fill(0);
}

void TouchList::add(std::uint16_t a, std::uint16_t b, bool linked, bool side_by_side) {
    if (a > b) std::swap(a, b);
    std::uint32_t& recent = recent_[(a * 13u + b) % recent_.size()];
    if (recent == 0 || entries_[recent - 1].a != a || entries_[recent - 1].b != b) {
        entries_.push_back({a, b});
        recent = static_cast<std::uint32_t>(entries_.size());
    }
    entries_[recent - 1].linked += linked ? 1 : 0;
    entries_[recent - 1].side_by_side += side_by_side ? 1 : 0;
}

void TouchList::gather(MergedLabels& merged) {
    recent_.fill(0);
    for (Touch& touch : entries_) {
        const std::uint16_t a = merged.find(touch.a), b = merged.find(touch.b);
        touch.a = std::min(a, b);
        touch.b = std::max(a, b);
    }
    std::erase_if(entries_, [](const Touch& t) { return t.a == t.b; });
    std::sort(entries_.begin(), entries_.end(),
              [](const Touch& s, const Touch& t) { return std::pair(s.a, s.b) < std::pair(t.a, t.b); });
    std::size_t count = 0;
    for (const Touch& touch : entries_) {
        if (count > 0 && entries_[count - 1].a == touch.a && entries_[count - 1].b == touch.b) {
            entries_[count - 1].linked += touch.linked;
            entries_[count - 1].side_by_side += touch.side_by_side;
        } else {
            entries_[count++] = touch;
        }
    }
    entries_.resize(count);
}

void merge_regions(const MergeRules& rules, std::vector<MergeRegion>& regions, TouchList& touching,
                   MergedLabels& merged) {
    merged.reset(regions.size() + 1);
    touching.gather(merged);
    while (true) {
        const Touch* best = nullptr;
        double best_cost = 1;
        for (Touch& touch : touching.entries()) {
            if (touch.cost < 0) touch.cost = merge_cost(rules, regions, touch);
            if (touch.cost < best_cost) best_cost = touch.cost, best = &touch;
        }
        if (best == nullptr) return;
        const std::uint16_t into_label = best->a, from_label = best->b;
        MergeRegion &into = regions[into_label - 1], &from = regions[from_label - 1];
        into.sums += from.sums;
        into.pixels += from.pixels;
        into.cells += from.cells;
        into.fit = into.sums.fit();
        from = MergeRegion{};
        merged.join(into_label, from_label);
        for (Touch& touch : touching.entries()) {
            if (touch.a == into_label || touch.b == into_label || touch.a == from_label ||
                touch.b == from_label)
                touch.cost = -1;
        }
        touching.gather(merged);
    }
}

}  // namespace planemap::segmentation
