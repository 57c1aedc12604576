// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/chains.hpp"

#include <iterator>

namespace planemap::odometry {

int Chains::add(int id, int previous_id) {
    const int chain = previous_id < 0 ? id : of(previous_id);
    remember(id, chain);
    return chain;
}

void Chains::remember(int id, int chain) {
    constexpr std::size_t kMostRuns = 4096;
    if (runs_.empty() || runs_.rbegin()->second != chain) runs_.emplace_hint(runs_.end(), id, chain);
    if (runs_.size() > kMostRuns) runs_.erase(runs_.begin());
}

int Chains::of(int id) const {
    const auto next = runs_.upper_bound(id);
    return next == runs_.begin() ? -1 : std::prev(next)->second;
}

}  // namespace planemap::odometry
