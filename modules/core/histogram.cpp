// SPDX-License-Identifier: BSD-3-Clause
#include "core/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace planemap {

namespace {
constexpr double kSmallest = 1e-4;
const double kLogStep = std::log(1.02);
}  // namespace

void Histogram::add(double value) {
    if (std::isnan(value)) return;
    const double position = std::log(std::max(value, kSmallest) / kSmallest) / kLogStep;
    const int bucket = static_cast<int>(std::min(position, kBuckets - 1.0));
    ++buckets_[static_cast<std::size_t>(bucket)];
    ++count_;
    sum_ += value;
}

double Histogram::quantile(double q) const {
    if (count_ == 0) return 0;
    const auto rank = static_cast<std::int64_t>(std::clamp(q, 0.0, 1.0) * static_cast<double>(count_ - 1));
    std::int64_t seen = 0;
    for (int bucket = 0; bucket < kBuckets; ++bucket) {
        seen += buckets_[static_cast<std::size_t>(bucket)];
        if (seen > rank) return kSmallest * std::exp((bucket + 0.5) * kLogStep);
    }
    return 0;
}

}  // namespace planemap
