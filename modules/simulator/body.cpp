// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/body.hpp"

#include <algorithm>

namespace planemap::simulator {

Pose Body::pose_at(double seconds) const {
    if (path.empty()) return Pose::Identity();
    const auto next = std::upper_bound(path.begin(), path.end(), seconds,
                                       [](double t, const Key& key) { return t < key.seconds; });
    if (next == path.begin()) return path.front().world_from_rest;
    if (next == path.end()) return path.back().world_from_rest;
    const Key &a = *(next - 1), &b = *next;
    return interpolate(a.world_from_rest, b.world_from_rest, (seconds - a.seconds) / (b.seconds - a.seconds));
}

std::vector<Body::Stay> Body::stays(double least_s) const {
    std::vector<Stay> all;
    const auto add = [&](double from, double until, const Pose& pose) {
        const Stay stay{std::max(from, from_s), std::min(until, until_s), pose};
        if (stay.until_s > stay.from_s) all.push_back(stay);
    };
    if (path.empty()) {
        add(-kAlways, kAlways, Pose::Identity());
    } else {
        add(-kAlways, path.front().seconds, path.front().world_from_rest);
        for (std::size_t i = 1; i < path.size(); ++i) {
            if (path[i - 1].world_from_rest.isApprox(path[i].world_from_rest, 1e-12))
                add(path[i - 1].seconds, path[i].seconds, path[i].world_from_rest);
        }
        add(path.back().seconds, kAlways, path.back().world_from_rest);
    }
    std::vector<Stay> joined;
    for (const Stay& stay : all) {
        const bool same = !joined.empty() && joined.back().until_s == stay.from_s &&
                          joined.back().world_from_rest.isApprox(stay.world_from_rest, 1e-12);
        if (same) {
            joined.back().until_s = stay.until_s;
        } else {
            joined.push_back(stay);
        }
    }
    std::erase_if(joined, [&](const Stay& stay) { return stay.until_s - stay.from_s < least_s; });
    return joined;
}

}  // namespace planemap::simulator
