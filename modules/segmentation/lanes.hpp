// SPDX-License-Identifier: BSD-3-Clause
// Eight pixels or eight cells at once. Two forms with the same meaning and, bit for bit, the same results:
// the vector types of GCC and Clang, which become whatever instructions the target has, and arrays of eight
// with loops over them (PLANEMAP_PORTABLE_LANES), which is plain C++.
//
// Include this from the kernels' files only: each is compiled for an instruction set of its own, and what is
// defined here must not be shared between them. Hence the anonymous namespace.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef PLANEMAP_PORTABLE_LANES
#include <algorithm>
#include <utility>
#elif defined(__AVX2__)
#include <immintrin.h>
#endif

namespace planemap::segmentation {
namespace {

#ifndef PLANEMAP_PORTABLE_LANES

using Float8 [[gnu::vector_size(32)]] = float;
using Double8 [[gnu::vector_size(64)]] = double;
using Int8 [[gnu::vector_size(32)]] = std::int32_t;
using Short8 [[gnu::vector_size(16)]] = std::uint16_t;

#ifdef __AVX2__
// What GCC makes of the general form takes several times as many instructions.
inline Int8 widen(Short8 x) {
    return reinterpret_cast<Int8>(_mm256_cvtepu16_epi32(reinterpret_cast<__m128i>(x)));
}
inline Short8 narrow(Int8 x) {
    const auto all = reinterpret_cast<__m256i>(x);
    return reinterpret_cast<Short8>(
        _mm_packus_epi32(_mm256_castsi256_si128(all), _mm256_extracti128_si256(all, 1)));
}
inline Short8 narrow_mask(Int8 x) {
    const auto all = reinterpret_cast<__m256i>(x);
    return reinterpret_cast<Short8>(
        _mm_packs_epi32(_mm256_castsi256_si128(all), _mm256_extracti128_si256(all, 1)));
}
#else
inline Int8 widen(Short8 x) {
    return __builtin_convertvector(x, Int8);
}
/// Values of 0 to 65535.
inline Short8 narrow(Int8 x) {
    return __builtin_convertvector(x, Short8);
}
/// A comparison's result.
inline Short8 narrow_mask(Int8 x) {
    return __builtin_convertvector(x, Short8);
}
#endif
inline Float8 to_float(Int8 x) {
    return __builtin_convertvector(x, Float8);
}
inline Double8 to_double(Float8 x) {
    return __builtin_convertvector(x, Double8);
}
inline Float8 to_float(Double8 x) {
    return __builtin_convertvector(x, Float8);
}
/// a where the mask (a comparison's result) is set, else b.
template <typename Mask, typename T>
inline T select(Mask mask, T a, T b) {
    return mask ? a : b;
}
inline Float8 bits_as_float(Int8 x) {
    Float8 y;
    std::memcpy(&y, &x, sizeof(y));
    return y;
}
inline Int8 bits_as_int(Float8 x) {
    Int8 y;
    std::memcpy(&y, &x, sizeof(y));
    return y;
}

inline Short8 smaller(Short8 a, Short8 b) {
    return a < b ? a : b;
}
inline Short8 larger(Short8 a, Short8 b) {
    return a > b ? a : b;
}

/// All ones where it holds, else 0.
inline Short8 equal(Short8 a, Short8 b) {
    return reinterpret_cast<Short8>(a == b);
}

/// Lane j of v[i] goes to lane i of v[j].
inline void transpose(Float8* v) {
    Float8 a[8], b[8];
    for (int i = 0; i < 8; i += 2) {
        a[i] = __builtin_shufflevector(v[i], v[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        a[i + 1] = __builtin_shufflevector(v[i], v[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; i += 4) {
        b[i] = __builtin_shufflevector(a[i], a[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
        b[i + 1] = __builtin_shufflevector(a[i], a[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        b[i + 2] = __builtin_shufflevector(a[i + 1], a[i + 3], 0, 1, 8, 9, 4, 5, 12, 13);
        b[i + 3] = __builtin_shufflevector(a[i + 1], a[i + 3], 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int i = 0; i < 4; ++i) {
        v[i] = __builtin_shufflevector(b[i], b[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        v[i + 4] = __builtin_shufflevector(b[i], b[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

/// The sums over the lanes of eight vectors.
inline Float8 lane_sums(const Float8* v) {
    const auto pair = [](Float8 a, Float8 b) {
        return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13) +
               __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    };
    const auto four = [](Float8 ab, Float8 cd) {
        return __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13) +
               __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    const Float8 low = four(pair(v[0], v[1]), pair(v[2], v[3])),
                 high = four(pair(v[4], v[5]), pair(v[6], v[7]));
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(low, high, 4, 5, 6, 7, 12, 13, 14, 15);
}

#else

/// N values that are added, compared and so on lane by lane; a comparison gives -1 where it holds, else 0.
template <typename T>
struct Lanes {
    T lane[8];

    T& operator[](std::size_t i) { return lane[i]; }
    const T& operator[](std::size_t i) const { return lane[i]; }
};

using Float8 = Lanes<float>;
using Double8 = Lanes<double>;
using Int8 = Lanes<std::int32_t>;
using Short8 = Lanes<std::uint16_t>;

template <typename R, typename F>
inline Lanes<R> each(F&& f) {
    Lanes<R> out;
    for (std::size_t i = 0; i < 8; ++i) out[i] = static_cast<R>(f(i));
    return out;
}

#define PLANEMAP_OPERATOR(op)                                           \
    template <typename T>                                               \
    inline Lanes<T> operator op(const Lanes<T>& a, const Lanes<T>& b) { \
        return each<T>([&](std::size_t i) { return a[i] op b[i]; });    \
    }                                                                   \
    template <typename T>                                               \
    inline Lanes<T> operator op(const Lanes<T>& a, T b) {               \
        return each<T>([&](std::size_t i) { return a[i] op b; });       \
    }                                                                   \
    template <typename T>                                               \
    inline Lanes<T> operator op(T a, const Lanes<T>& b) {               \
        return each<T>([&](std::size_t i) { return a op b[i]; });       \
    }
PLANEMAP_OPERATOR(+)
PLANEMAP_OPERATOR(-)
PLANEMAP_OPERATOR(*)
PLANEMAP_OPERATOR(/)
PLANEMAP_OPERATOR(&)
PLANEMAP_OPERATOR(|)
#undef PLANEMAP_OPERATOR

#define PLANEMAP_COMPARISON(op)                                                          \
    template <typename T>                                                                \
    inline Int8 operator op(const Lanes<T>& a, const Lanes<T>& b) {                      \
        return each<std::int32_t>([&](std::size_t i) { return a[i] op b[i] ? -1 : 0; }); \
    }                                                                                    \
    template <typename T>                                                                \
    inline Int8 operator op(const Lanes<T>& a, T b) {                                    \
        return each<std::int32_t>([&](std::size_t i) { return a[i] op b ? -1 : 0; });    \
    }
PLANEMAP_COMPARISON(<)
PLANEMAP_COMPARISON(<=)
PLANEMAP_COMPARISON(>)
PLANEMAP_COMPARISON(>=)
PLANEMAP_COMPARISON(==)
#undef PLANEMAP_COMPARISON

template <typename T>
inline Lanes<T>& operator+=(Lanes<T>& a, const Lanes<T>& b) {
    return a = a + b;
}
template <typename T>
inline Lanes<T>& operator-=(Lanes<T>& a, const Lanes<T>& b) {
    return a = a - b;
}
inline Float8 operator-(const Float8& a) {
    return each<float>([&](std::size_t i) { return -a[i]; });
}

inline Int8 widen(const Short8& x) {
    return each<std::int32_t>([&](std::size_t i) { return x[i]; });
}
inline Short8 narrow(const Int8& x) {
    return each<std::uint16_t>([&](std::size_t i) { return x[i]; });
}
inline Short8 narrow_mask(const Int8& x) {
    return narrow(x);
}
inline Float8 to_float(const Int8& x) {
    return each<float>([&](std::size_t i) { return x[i]; });
}
inline Double8 to_double(const Float8& x) {
    return each<double>([&](std::size_t i) { return x[i]; });
}
inline Float8 to_float(const Double8& x) {
    return each<float>([&](std::size_t i) { return x[i]; });
}
template <typename Mask, typename T>
inline T select(const Mask& mask, const T& a, const T& b) {
    T out;
    for (std::size_t i = 0; i < 8; ++i) out[i] = mask[i] ? a[i] : b[i];
    return out;
}
inline Float8 bits_as_float(const Int8& x) {
    Float8 y;
    std::memcpy(&y, &x, sizeof(y));
    return y;
}
inline Int8 bits_as_int(const Float8& x) {
    Int8 y;
    std::memcpy(&y, &x, sizeof(y));
    return y;
}
inline Short8 smaller(const Short8& a, const Short8& b) {
    return each<std::uint16_t>([&](std::size_t i) { return std::min(a[i], b[i]); });
}
inline Short8 larger(const Short8& a, const Short8& b) {
    return each<std::uint16_t>([&](std::size_t i) { return std::max(a[i], b[i]); });
}
inline Short8 equal(const Short8& a, const Short8& b) {
    return each<std::uint16_t>([&](std::size_t i) { return a[i] == b[i] ? 0xffff : 0; });
}
inline void transpose(Float8* v) {
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t j = 0; j < i; ++j) std::swap(v[i][j], v[j][i]);
    }
}
inline Float8 lane_sums(const Float8* v) {
    return each<float>([&](std::size_t i) {
        const Float8& x = v[i];
        return ((x[0] + x[2]) + (x[1] + x[3])) + ((x[4] + x[6]) + (x[5] + x[7]));
    });
}

#endif

inline Float8 splat(float x) {
    return Float8{x, x, x, x, x, x, x, x};
}
inline Int8 splat(std::int32_t x) {
    return Int8{x, x, x, x, x, x, x, x};
}
inline Short8 splat(std::uint16_t x) {
    return Short8{x, x, x, x, x, x, x, x};
}
inline Double8 splat(double x) {
    return Double8{x, x, x, x, x, x, x, x};
}

template <typename Lane8, typename T>
inline Lane8 load(const T* from) {
    Lane8 x;
    static_assert(sizeof(x) == 8 * sizeof(T));
    std::memcpy(&x, from, sizeof(x));
    return x;
}
template <typename Lane8, typename T>
inline void store(const Lane8& x, T* to) {
    static_assert(sizeof(x) == 8 * sizeof(T));
    std::memcpy(to, &x, sizeof(x));
}

/// Zero where the mask is not set.
inline Float8 masked(const Float8& x, const Int8& mask) {
    return bits_as_float(bits_as_int(x) & mask);
}
inline Float8 absolute(const Float8& x) {
    return bits_as_float(bits_as_int(x) & splat(0x7fffffff));
}
/// All ones where a value lies within low and high, else 0. Precondition: low <= high.
inline Short8 within(const Short8& x, const Short8& low, const Short8& high) {
    return equal(smaller(larger(x, low), high), x);
}
inline Float8 square_root(const Float8& x) {
#if defined(__AVX2__) && !defined(PLANEMAP_PORTABLE_LANES)
    return reinterpret_cast<Float8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#else
    Float8 y = x;
    for (std::size_t k = 0; k < 8; ++k) y[k] = std::sqrt(x[k]);
    return y;
#endif
}
inline int sum_of(const Short8& x) {
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

}  // namespace
}  // namespace planemap::segmentation
