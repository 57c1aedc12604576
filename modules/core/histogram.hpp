// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace planemap {

/// Quantiles of positive values (times in ms, say) in constant memory: buckets 2 % wide from 1e-4 to 1e5, so
/// a quantile is right within 1 % however many values were added.
class Histogram {
  public:
    /// Values outside the range count in the first or last bucket; NaN is ignored.
    void add(double value);
    std::int64_t count() const { return count_; }
    double sum() const { return sum_; }
    /// q in [0, 1]; 0 for an empty histogram.
    double quantile(double q) const;
    double median() const { return quantile(0.5); }
    double p95() const { return quantile(0.95); }

  private:
    static constexpr int kBuckets = 1048;  // ln(1e9) / ln(1.02)
    std::array<std::uint32_t, kBuckets> buckets_{};
    std::int64_t count_ = 0;
    double sum_ = 0;
};

}  // namespace planemap
