// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/packed_outline.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace planemap {
namespace {

TEST(PackedOutline, AppendsRingsInSteps) {
    std::vector<std::int16_t> packed{-1};
    const float unit =
        pack(Outline{{Ring{{0, 0}, {1.0004, 0}, {0, -2}}, Ring{{0.1, 0.1}, {0.2, 0.1}, {0.1, 0.2}}}}, packed);
    EXPECT_FLOAT_EQ(unit, 0.001f);
    EXPECT_EQ(packed,
              (std::vector<std::int16_t>{-1, 3, 0, 0, 1000, 0, 0, -2000, 3, 100, 100, 200, 100, 100, 200}));
}

TEST(PackedOutline, TakesCoarserStepsForWhatReachesFurther) {
    std::vector<std::int16_t> packed;
    const float unit = pack(Outline{{Ring{{-100, 0}, {50, 0}, {0, 65.534}}}}, packed);
    EXPECT_FLOAT_EQ(unit, static_cast<float>(100 / 32767.0));
    EXPECT_EQ(packed[1], -32767);
}

TEST(PackedOutline, IsWalkedRingByRing) {
    const std::vector<std::int16_t> packed{3, 1, 2, 3, 4, 5, 6, 0, 2, 7, 8, 9, 10};
    std::vector<std::size_t> sizes;
    std::vector<int> values;
    for_each_packed(
        packed, [&](std::size_t size) { sizes.push_back(size); },
        [&](int x, int y) {
            values.insert(values.end(), {x, y});
        });
    EXPECT_EQ(sizes, (std::vector<std::size_t>{3, 0, 2}));
    EXPECT_EQ(values, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST(PackedOutline, RefusesARingThatItsSizeCannotSay) {
    std::vector<std::int16_t> packed;
    Outline outline{{Ring(kMaxRingVertices, Eigen::Vector2d::Zero())}};
    EXPECT_NO_THROW(pack(outline, packed));
    outline.rings[0].emplace_back(0, 0);
    EXPECT_THROW(pack(outline, packed), std::length_error);
}

}  // namespace
}  // namespace planemap
