// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "graph/loop_closure.hpp"

namespace planemap::graph {

/// The loop closures that were accepted, numbered from 0 in the order they were found. It remembers the
/// newest: of more than 512, between 256 and 512.
class ClosureHistory {
  public:
    ClosureHistory() { newest_.reserve(kMostKept + 1); }

    /// Returns the number of the closure.
    std::int64_t add(const LoopClosure& closure);
    /// What the last optimisation made of a closure; nothing for one that is not remembered, or of no number
    /// (-1).
    void set_weight(std::int64_t number, double weight);

    const std::vector<LoopClosure>& newest() const { return newest_; }
    /// How many there were in all.
    int count() const { return static_cast<int>(first_) + static_cast<int>(newest_.size()); }
    std::size_t memory_bytes() const { return newest_.capacity() * sizeof(LoopClosure); }

  private:
    static constexpr std::size_t kMostKept = 512;

    std::vector<LoopClosure> newest_;
    std::int64_t first_ = 0;  ///< number of the first of them
};

}  // namespace planemap::graph
