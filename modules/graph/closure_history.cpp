// SPDX-License-Identifier: BSD-3-Clause
#include "graph/closure_history.hpp"

namespace planemap::graph {

std::int64_t ClosureHistory::add(const LoopClosure& closure) {
    const std::int64_t number = count();
    newest_.push_back(closure);
    if (newest_.size() > kMostKept) {
        newest_.erase(newest_.begin(), newest_.begin() + kMostKept / 2);
        first_ += kMostKept / 2;
    }
    return number;
}

void ClosureHistory::set_weight(std::int64_t number, double weight) {
    if (number < first_ || number >= count()) return;
    newest_[static_cast<std::size_t>(number - first_)].weight = weight;
}

}  // namespace planemap::graph
