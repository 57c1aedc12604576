// SPDX-License-Identifier: BSD-3-Clause
#include "graph/successors.hpp"

namespace planemap::graph {

void Successors::add(int gone_id, const Successor& successor) {
    constexpr std::size_t kMostKnown = 512;
    for (auto& [gone, s] : gone_) {
        if (s.keeper_id != gone_id) continue;
        s = {successor.keeper_id, successor.keeper_from_gone * s.keeper_from_gone, s.drift + successor.drift};
    }
    gone_[gone_id] = successor;
    if (gone_.size() > kMostKnown) gone_.erase(gone_.begin());
}

const Successor* Successors::of(int gone_id) const {
    const auto found = gone_.find(gone_id);
    return found == gone_.end() ? nullptr : &found->second;
}

}  // namespace planemap::graph
