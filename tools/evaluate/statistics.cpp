// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace planemap {

Statistics statistics(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto n = static_cast<double>(values.size());
    const std::size_t half = values.size() / 2;
    Statistics result;
    result.count = values.size();
    result.rmse = std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / n);
    result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    result.median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    double squares = 0.0;
    for (const double value : values) squares += (value - result.mean) * (value - result.mean);
    result.std = std::sqrt(squares / n);
    result.min = values.front();
    result.max = values.back();
    return result;
}

double nearest_rank(std::vector<double> values, double rank) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto place = static_cast<std::size_t>(std::ceil(rank * static_cast<double>(values.size())));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(place, 1) - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace planemap
