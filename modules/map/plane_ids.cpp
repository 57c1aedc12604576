// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_ids.hpp"

#include <algorithm>
#include <set>

namespace planemap::map {

void PlaneIds::reserve(int id) {
    *next_ = std::max(*next_, id + 1);
}

std::map<int, int> PlaneIds::carry_over(const std::vector<int>& now, const std::vector<int>& kept,
                                        const Votes& votes, int first_provisional) {
    std::map<int, int> id_of;  // now: to be
    std::set<int> taken;
    for (const int id : kept) {
        if (std::find(now.begin(), now.end(), id) == now.end()) continue;
        id_of[id] = id;
        taken.insert(id);
    }
    std::vector<std::pair<double, std::pair<int, int>>> claims;
    claims.reserve(votes.size());
    for (const auto& [pair, inliers] : votes) claims.push_back({-inliers, pair});
    std::sort(claims.begin(), claims.end());
    for (const auto& [inliers, pair] : claims) {
        if (id_of.contains(pair.second) || taken.contains(pair.first)) continue;
        id_of[pair.second] = pair.first;
        taken.insert(pair.first);
    }
    *next_ = first_provisional;
    for (const int id : now) {
        if (id_of.try_emplace(id, *next_).second) ++*next_;
    }
    return id_of;
}

}  // namespace planemap::map
