// SPDX-License-Identifier: BSD-3-Clause
// The kernels' code; a file that includes it says which instruction set it is compiled for.
#include "core/registration_kernels.hpp"

namespace planemap {
namespace {

void project(const ReadingsRow& row, const LandedRow& landed) {
    // The first term of q is linear in u along a row.
    const float mx = row.along[0], my = row.along[1], mz = row.along[2];
    const float base_x = row.base[0], base_y = row.base[1], base_z = row.base[2];
    const float tx = row.t[0], ty = row.t[1], tz = row.t[2];
    const float width = row.color_width, height = row.color_height;
    const std::uint16_t* const readings = row.readings;
    float* const __restrict x = landed.x, * const __restrict y = landed.y, * const __restrict z = landed.z;
    // Without a branch, for the compiler to take several pixels at a time.
    for (int u = 0; u < row.width; ++u) {
        const float raw = static_cast<float>(readings[u]), column = static_cast<float>(u);
        const float qz = (base_z + mz * column) * raw + tz;
        const float inverse = 1.0f / qz;  // infinite, and no pixel, for qz = 0
        const float qx = ((base_x + mx * column) * raw + tx) * inverse + 0.5f;
        const float qy = ((base_y + my * column) * raw + ty) * inverse + 0.5f;
        const bool lands = (raw != 0) & (raw != 65535) & (qz >= 0.5f) & (qz < 65534.5f) & (qx >= 0) &
                           (qy >= 0) & (qx < width) & (qy < height);
        x[u] = lands ? qx : 0.0f;
        y[u] = lands ? qy : 0.0f;
        z[u] = lands ? qz : -1.0f;
    }
}

void address(const LandedRow& landed, int width, int color_width, int* __restrict index,
             std::uint16_t* __restrict depth) {
    const float *const x = landed.x, *const y = landed.y, *const z = landed.z;
    // NOLINTBEGIN(bugprone-incorrect-roundings): depth is at least 1, where adding a half is exact
    for (int u = 0; u < width; ++u) {
        index[u] = static_cast<int>(y[u]) * color_width + static_cast<int>(x[u]);
        depth[u] = static_cast<std::uint16_t>(static_cast<int>(z[u] + 0.5f));
    }
    // NOLINTEND(bugprone-incorrect-roundings)
}

}  // namespace
}  // namespace planemap
