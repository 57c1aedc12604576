// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/random.hpp"

#include <cmath>
#include <numbers>

namespace planemap::simulator {

GaussianTable::GaussianTable() {
    // Newton's method on the distribution function, from each quantile to the next.
    constexpr double kStep = 1.0 / (kMask + 1);
    double x = -3.7;
    double sum_of_squares = 0;
    for (std::size_t i = 0; i <= kMask; ++i) {
        const double target = (static_cast<double>(i) + 0.5) * kStep;
        for (int iteration = 0; iteration < 50; ++iteration) {
            const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - target;
            const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
            x -= error / density;
            if (std::fabs(error) < 1e-14) break;
        }
        values_[i] = static_cast<float>(x);
        sum_of_squares += x * x;
    }
    // The tails are cut off: bring the variance back to one.
    const double scale = std::sqrt(static_cast<double>(kMask + 1) / sum_of_squares);
    for (float& value : values_) value = static_cast<float>(value * scale);
}

}  // namespace planemap::simulator
