// SPDX-License-Identifier: BSD-3-Clause
#include "core/depth_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/lens_distortion.hpp"

namespace planemap {

namespace {

/// A place between two neighbouring nodes of `count`, of a pixel of `size`.
struct Between {
    std::size_t first;
    double share;  ///< of the second

    Between(double pixel, int size, std::size_t count) {
        const double place = std::clamp((pixel + 0.5) / size, 0.0, 1.0) * static_cast<double>(count - 1);
        first = std::min(static_cast<std::size_t>(place), count - 2);
        share = place - static_cast<double>(first);
    }
};

/// The field along a row of the image, 1 / raw units, at the nodes' columns.
std::array<float, DepthCorrection::kColumns> along_row(const DepthCorrection& correction, double units, int v,
                                                       int height) {
    constexpr std::size_t kColumns = DepthCorrection::kColumns;
    const Between rows(v, height, DepthCorrection::kRows);
    std::array<float, kColumns> field;
    for (std::size_t column = 0; column < kColumns; ++column) {
        const double* const node = &correction.offsets[rows.first * kColumns + column];
        field[column] =
            static_cast<float>(((1 - rows.share) * node[0] + rows.share * node[kColumns]) / units);
    }
    return field;
}

std::uint16_t corrected(std::uint16_t raw, float offset) {
    if (!is_valid_depth(raw)) return raw;
    const float z = static_cast<float>(raw) / (1 + static_cast<float>(raw) * offset);
    if (!(z >= 0.5f && z < 65534.5f)) return 0;
    return static_cast<std::uint16_t>(z + 0.5f);  // NOLINT(bugprone-incorrect-roundings): exact from 0.5 on
}

}  // namespace

FieldWeights field_weights(const PinholeCamera& depth, double u, double v) {
    constexpr std::size_t kColumns = DepthCorrection::kColumns, kRows = DepthCorrection::kRows;
    const Between x(u, depth.width, kColumns), y(v, depth.height, kRows);
    const std::size_t node = y.first * kColumns + x.first;
    return {
        {node, node + 1, node + kColumns, node + kColumns + 1},
        {(1 - x.share) * (1 - y.share), x.share * (1 - y.share), (1 - x.share) * y.share, x.share * y.share}};
}

FieldWeights field_weights(const CameraInfo& sensed, double u, double v) {
    const Eigen::Vector2d place = sensed_pixel(sensed.depth, sensed.depth_distortion, {u, v});
    return field_weights(sensed.depth, place.x(), place.y());
}

DepthCorrection composed(const DepthCorrection& first, const DepthCorrection& second) {
    DepthCorrection both = second;
    for (std::size_t i = 0; i < both.offsets.size(); ++i) both.offsets[i] += first.offsets[i];
    return both;
}

void correct_depth(DepthImage& depth, const CameraInfo& camera) {
    if (!camera.depth_correction) return;
    std::vector<Between> columns;
    columns.reserve(static_cast<std::size_t>(depth.width));
    for (int u = 0; u < depth.width; ++u) columns.emplace_back(u, depth.width, DepthCorrection::kColumns);
    for (int v = 0; v < depth.height; ++v) {
        const auto field = along_row(*camera.depth_correction, camera.depth_units_per_metre, v, depth.height);
        std::uint16_t* row = depth.row(v);
        for (const Between& column : columns) {
            const float left = field[column.first], right = field[column.first + 1];
            *row = corrected(*row, left + static_cast<float>(column.share) * (right - left));
            ++row;
        }
    }
}

}  // namespace planemap
