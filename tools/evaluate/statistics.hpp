// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace planemap {

/// Figures of a set of errors, in the errors' unit. The standard deviation is the population's (divided by
/// count); the median of an even count is the mean of the middle two. All zero for no values.
struct Statistics {
    std::size_t count = 0;
    double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;
};
Statistics statistics(std::vector<double> values);

/// The value that the share `rank` (0 to 1) of the values does not exceed, by the nearest rank: 0.5 is a
/// median that is one of them. NaN for none.
double nearest_rank(std::vector<double> values, double rank);

/// A part of a whole; nothing where there is nothing to have a share of.
inline std::optional<double> share(double part, double whole) {
    return whole > 0 ? std::optional(part / whole) : std::nullopt;
}

}  // namespace planemap
