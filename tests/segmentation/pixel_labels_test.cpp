// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/pixel_labels.hpp"

#include <gtest/gtest.h>

#include "segmentation/labelling.hpp"

namespace planemap::segmentation {
namespace {

TEST(PixelLabellerTest, APlaneIsFollowedFromOneCellOverTheImage) {
    const Labelling from_one(wall(), [](int x, int y) { return x == 10 && y == 7; });
    EXPECT_EQ(from_one.labelled(), 160 * 120);
    const Labelling from_all(wall(), [](int, int) { return true; });
    EXPECT_EQ(from_one.labels.pixels, from_all.labels.pixels);
}

TEST(PixelLabellerTest, ItEndsAtTheLastPixel) {
    DepthImage depth = wall();
    for (int v = 0; v < depth.height; ++v)
        for (int u = 91; u < depth.width; ++u) depth(u, v) = static_cast<std::uint16_t>(depth(u, v) / 2);
    const Labelling result(depth, [](int x, int y) { return x == 5 && y == 7; });
    for (int v = 0; v < depth.height; ++v)
        for (int u = 0; u < depth.width; ++u)
            EXPECT_EQ(result.labels(u, v), u < 91 ? 1 : 0) << u << ", " << v;
}

TEST(PixelLabellerTest, InvalidReadingsCarryNoLabelAndNothingIsNothing) {
    DepthImage depth = wall();
    depth(80, 60) = 0;
    const Labelling holed(depth, [](int, int) { return true; });
    EXPECT_EQ(holed.labels(80, 60), 0);
    EXPECT_EQ(holed.labelled(), 160 * 120 - 1);
    const Labelling nowhere(wall(), [](int, int) { return false; });
    EXPECT_EQ(nowhere.labelled(), 0);
    const Labelling empty(DepthImage(160, 120, 0), [](int, int) { return true; });
    EXPECT_EQ(empty.labelled(), 0);
    EXPECT_EQ(empty.sums.at(0).points.n, 0);
}

}  // namespace
}  // namespace planemap::segmentation
