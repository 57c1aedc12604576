// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace planemap::evaluation {

/// Few of a series of any length, spread evenly over it: every one until there are `most`, then every second
/// one and so on, the earlier ones thinned out alike. So at least half of `most` are kept of a long series,
/// and which ones depends on their number alone.
template <typename T>
class Spread {
  public:
    /// Precondition: most > 1.
    explicit Spread(std::size_t most) : most_(most) {}

    /// Counts the next of the series: true if it is one of those to keep. Then add() must follow.
    bool wants_next() {
        const std::int64_t number = count_++;
        if (number % every_ != 0) return false;
        if (kept_.size() < most_) return true;
        thin_out();
        return number % every_ == 0;
    }
    void add(T value) { kept_.push_back(std::move(value)); }
    const std::vector<T>& kept() const { return kept_; }

  private:
    void thin_out() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < kept_.size(); i += 2, ++kept)
            if (kept != i) kept_[kept] = std::move(kept_[i]);
        kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(kept), kept_.end());
        every_ *= 2;
    }

    std::size_t most_;
    std::vector<T> kept_;
    std::int64_t count_ = 0, every_ = 1;
};

}  // namespace planemap::evaluation
