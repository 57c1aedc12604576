// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace planemap::map {

/// Hands out the ids of planes, and carries them over when the planes are made anew. An id that was in a map
/// is not given to another plane. Copies hand out of one supply: maps that may become one share it.
class PlaneIds {
  public:
    /// Inliers that were in one plane (first) and are in another one now (second).
    using Votes = std::map<std::pair<int, int>, double>;

    /// A new id.
    int next() { return (*next_)++; }
    /// The one that next() would give.
    int upcoming() const { return *next_; }
    /// Takes an id that came with a plane from elsewhere.
    void reserve(int id);

    /// What planes made anew are to be called: each gets the id of the earlier plane that most of its inliers
    /// were in; each id once, the strongest claim first. `kept` keep theirs; planes without a claim get
    /// new ids, in the order of `now`. Takes back all ids from `first_provisional` on, which only `now` bear.
    std::map<int, int> carry_over(const std::vector<int>& now, const std::vector<int>& kept,
                                  const Votes& votes, int first_provisional);

  private:
    std::shared_ptr<int> next_ = std::make_shared<int>(0);
};

}  // namespace planemap::map
