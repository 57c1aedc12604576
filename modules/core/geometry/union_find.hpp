// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace planemap {

/// Disjoint sets of the numbers 0 to size() - 1. The least member of a set stands for it, whatever the order
/// in which sets were joined. Index is any integer type that holds them.
template <typename Index>
class UnionFind {
  public:
    /// As many sets of one member each.
    explicit UnionFind(std::size_t size = 0) { resize(size); }

    std::size_t size() const { return parent_.size(); }
    /// As a new one of that size, in the memory that there is.
    void reset(std::size_t size) {
        parent_.clear();
        resize(size);
    }
    /// Adds sets of one member each; what there is stays. Precondition: not less than size().
    void resize(std::size_t size) {
        parent_.reserve(size);
        while (parent_.size() < size) parent_.push_back(static_cast<Index>(parent_.size()));
    }

    /// The member that stands for this one's set. Not const: it halves the way for the next time.
    Index find(Index member) {
        while (parent(member) != member) member = parent(member) = parent(parent(member));
        return member;
    }
    /// Whether it stands for its set itself.
    bool stands(Index member) const { return parent_[static_cast<std::size_t>(member)] == member; }

    /// False when they were one set already.
    bool join(Index a, Index b) {
        const Index root_a = find(a), root_b = find(b);
        parent(std::max(root_a, root_b)) = std::min(root_a, root_b);
        return root_a != root_b;
    }

  private:
    Index& parent(Index member) { return parent_[static_cast<std::size_t>(member)]; }

    std::vector<Index> parent_;
};

}  // namespace planemap
