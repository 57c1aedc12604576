// SPDX-License-Identifier: BSD-3-Clause
// Four pixels at once, in the vector types of GCC and Clang: plain C++ arithmetic on every architecture.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace planemap {

using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;
using Short4 [[gnu::vector_size(8)]] = std::uint16_t;

inline Int4 load4(const std::uint16_t* pixels) {
    Short4 four;
    std::memcpy(&four, pixels, sizeof(four));
    return __builtin_convertvector(four, Int4);
}

inline void store4(Int4 values, std::uint16_t* pixels) {
    const Short4 four = __builtin_convertvector(values, Short4);
    std::memcpy(pixels, &four, sizeof(four));
}

inline Float4 to_float(Int4 values) {
    return __builtin_convertvector(values, Float4);
}

inline Float4 splat(float value) {
    return Float4{value, value, value, value};
}

inline Int4 splat(std::int32_t value) {
    return Int4{value, value, value, value};
}

/// 1 where the mask (a comparison's result: 0 or -1) is set, else 0.
inline Float4 one_where(Int4 mask) {
    return mask ? splat(1.0f) : splat(0.0f);
}

inline Float4 absolute(Float4 x) {
    return std::bit_cast<Float4>(std::bit_cast<Int4>(x) & splat(0x7fffffff));
}

inline double sum_of(Float4 x) {
    return static_cast<double>(x[0]) + static_cast<double>(x[1]) + static_cast<double>(x[2]) +
           static_cast<double>(x[3]);
}

inline int sum_of(Int4 x) {
    return x[0] + x[1] + x[2] + x[3];
}

}  // namespace planemap
