// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/crossing.hpp"

#include <gtest/gtest.h>

#include "core/random_values.hpp"

namespace planemap {
namespace {

TEST(CrossingRemover, LeavesWhatDoesNotCross) {
    Outline outline{{Ring{{0, 0}, {3, 0}, {3, 3}, {0, 3}}, Ring{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
    const Outline before = outline;
    EXPECT_EQ(CrossingRemover().remove(outline), 0);
    EXPECT_EQ(outline.rings, before.rings);
}

TEST(CrossingRemover, ASpikeThroughTheOtherSideGoesAndTheRestStays) {
    Outline outline{{Ring{{0, 0}, {4, 0}, {4, 1}, {2.1, 1}, {2, -0.5}, {1.9, 1}, {0, 1}}}};
    ASSERT_TRUE(rings_cross(outline));
    EXPECT_EQ(CrossingRemover().remove(outline), 1);
    EXPECT_FALSE(rings_cross(outline));
    EXPECT_NEAR(area(outline), 4, 0.2);
}

TEST(CrossingRemover, EndsWhateverTheRings) {
    test::Random random(1);
    CrossingRemover remover;
    for (int trial = 0; trial < 50; ++trial) {
        Outline outline;
        for (int r = random.integer(1, 3); r > 0; --r) {
            Ring ring;
            for (int i = random.integer(3, 30); i > 0; --i) ring.push_back(random.vector(1).head<2>());
            outline.rings.push_back(ring);
        }
        const std::size_t before = outline.vertex_count();
        const int removed = remover.remove(outline);
        EXPECT_FALSE(rings_cross(outline)) << trial;
        EXPECT_LE(outline.vertex_count() + static_cast<std::size_t>(removed), before);
        for (const Ring& ring : outline.rings) EXPECT_GE(ring.size(), 3u);
    }
}

}  // namespace
}  // namespace planemap
