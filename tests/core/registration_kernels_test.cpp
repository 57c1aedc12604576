// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration_kernels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace planemap {
namespace {

constexpr int kWidth = 61, kColorWidth = 70, kColorHeight = 50;

struct Landed {
    std::vector<float> x = std::vector<float>(kWidth), y = x, z = x;
    std::vector<int> index = std::vector<int>(kWidth);
    std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(kWidth);
};

Landed landed(const RegistrationKernels& kernels, const ReadingsRow& row) {
    Landed result;
    const LandedRow out{result.x.data(), result.y.data(), result.z.data()};
    kernels.project(row, out);
    kernels.address(out, kWidth, kColorWidth, result.index.data(), result.depth.data());
    return result;
}

std::vector<std::uint16_t> readings(std::mt19937& random) {
    std::vector<std::uint16_t> readings(kWidth);
    for (auto& raw : readings) raw = static_cast<std::uint16_t>(500 + random() % 4000);
    readings[3] = 0;
    readings[5] = 65535;
    readings[8] = 1;
    readings[9] = 65534;
    return readings;
}

/// A row of cameras of any kind, some of which see nothing, or nothing that is a number.
ReadingsRow any_row(const std::vector<std::uint16_t>& raw, std::mt19937& random, int kind) {
    std::uniform_real_distribution<float> small(-0.05f, 0.05f);
    ReadingsRow row{raw.data(),  kWidth, {1 + small(random), small(random), 0.001f * small(random)},
                    {},          {},     kColorWidth,
                    kColorHeight};
    row.base = {4 + small(random), 20 + small(random), 1 + small(random)};
    row.t = {500 * small(random), 500 * small(random), 100 * small(random)};
    if (kind == 1) row.t[2] = -2000;
    if (kind == 2) row.base[2] = 0;
    if (kind == 3) row.t[0] = std::numeric_limits<float>::infinity();
    if (kind == 4) row.base[1] = std::numeric_limits<float>::quiet_NaN();
    if (kind == 5) row.base[2] = 1e30f;
    return row;
}

TEST(RegistrationKernels, ReadingsLandWhereTheDefinitionSays) {
    std::mt19937 random(1);
    const std::vector<std::uint16_t> raw = readings(random);
    const ReadingsRow row = any_row(raw, random, 0);
    const Landed result = landed(baseline_registration_kernels(), row);
    int count = 0;
    for (std::size_t u = 0; u < kWidth; ++u) {
        const double z0 = raw[u], column = static_cast<double>(u);
        std::array<double, 3> q{};
        for (std::size_t i = 0; i < 3; ++i) q[i] = z0 * (row.base[i] + row.along[i] * column) + row.t[i];
        const double x = q[0] / q[2] + 0.5, y = q[1] / q[2] + 0.5;
        const bool is_reading = raw[u] != 0 && raw[u] != 65535 && q[2] >= 0.5 && q[2] < 65534.5;
        const bool lands = is_reading && x >= 0 && y >= 0 && x < kColorWidth && y < kColorHeight;
        count += lands;
        ASSERT_EQ(result.z[u] > 0, lands) << u;
        if (!lands) {
            EXPECT_EQ(result.index[u], 0);
            EXPECT_EQ(result.depth[u], 0);
            continue;
        }
        EXPECT_EQ(result.index[u], static_cast<int>(y) * kColorWidth + static_cast<int>(x)) << u;
        EXPECT_NEAR(result.depth[u], q[2], 0.51);
    }
    EXPECT_GT(count, 40);
}

TEST(RegistrationKernels, EveryInstructionSetGivesTheSameBits) {
    if (avx2_registration_kernels() == nullptr) GTEST_SKIP() << "this machine has no AVX2";
    std::mt19937 random(2);
    for (int i = 0; i < 60; ++i) {
        const std::vector<std::uint16_t> raw = readings(random);
        const ReadingsRow row = any_row(raw, random, i % 6);
        const Landed ours = landed(baseline_registration_kernels(), row),
                     theirs = landed(*avx2_registration_kernels(), row);
        EXPECT_EQ(ours.index, theirs.index);
        EXPECT_EQ(ours.depth, theirs.depth);
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): the same bits, of zeros and NaNs too
        EXPECT_EQ(std::memcmp(ours.z.data(), theirs.z.data(), kWidth * sizeof(float)), 0);
        for (const int index : ours.index) {
            EXPECT_GE(index, 0);
            EXPECT_LT(index, kColorWidth * kColorHeight);
        }
    }
}

}  // namespace
}  // namespace planemap
