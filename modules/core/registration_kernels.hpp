// SPDX-License-Identifier: BSD-3-Clause
// What registration does to every reading, compiled for more than one instruction set: each gives the same
// bits.
#pragma once

#include <array>
#include <cstdint>

namespace planemap {

/// From a reading to where the colour camera sees it: q = z (m (u, v, 1)) + t, pixel (q.x / q.z, q.y / q.z).
struct ReadingsRow {
    const std::uint16_t* readings;     ///< raw units
    int width;                         ///< readings
    std::array<float, 3> along, base;  ///< m's first column; m (0, v, 1)
    std::array<float, 3> t;            ///< raw units
    float color_width, color_height;   ///< pixels
};

/// Where the readings of a row land on the colour image.
struct LandedRow {
    float *x, *y;  ///< pixels, plus a half: rounded down they are indices; 0 for what lands nowhere
    float* z;      ///< depth along the colour camera's axis, raw units; -1: nowhere
};

struct RegistrationKernels {
    const char* name;
    void (*project)(const ReadingsRow& row, const LandedRow& landed);
    /// Index of the pixel and whole depth of each reading that landed; the first pixel and 0 for the others.
    void (*address)(const LandedRow& landed, int width, int color_width, int* index, std::uint16_t* depth);
};

const RegistrationKernels& baseline_registration_kernels();
/// Null where the machine has no AVX2.
const RegistrationKernels* avx2_registration_kernels();
const RegistrationKernels& best_registration_kernels();

}  // namespace planemap
