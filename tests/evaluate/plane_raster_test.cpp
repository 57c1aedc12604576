// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_raster.hpp"

#include <gtest/gtest.h>

namespace planemap::evaluation {
namespace {

Outline square(double x, double y, double side) {
    return {{{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}}};
}

TEST(PlaneRaster, HoldsWhatIsInsideTheOutline) {
    const PlaneRaster raster = rasterised(square(-0.7, 3.1, 1));
    EXPECT_NEAR(raster.area(), 1, 0.05);
    EXPECT_LT((raster.centre() - Eigen::Vector2d(-0.2, 3.6)).norm(), PlaneRaster::kCell_m);
    for_each_cell(raster, [&](int x, int y) {
        EXPECT_TRUE(contains(square(-0.7, 3.1, 1), raster.cell_centre(x, y)));
        EXPECT_TRUE(raster.at(x, y));
    });
}

TEST(PlaneRaster, RastersOfOnePlaneShareALattice) {
    const PlaneRaster a = rasterised(square(0, 0, 1)), b = rasterised(square(0.511, 0, 1));
    const PlaneRaster both = united(a, b);
    std::size_t common = 0;
    for_each_cell(a, [&](int x, int y) { common += b.at(x, y); });
    EXPECT_EQ(both.count(), a.count() + b.count() - common);
    EXPECT_GT(common, 0u);
    EXPECT_EQ(united(both, a).count(), both.count());
}

TEST(PlaneRaster, NothingIsNothing) {
    EXPECT_EQ(rasterised({}).count(), 0u);
    EXPECT_FALSE(PlaneRaster().at(0, 0));
    EXPECT_EQ(united({}, rasterised(square(0, 0, 1))).count(), rasterised(square(0, 0, 1)).count());
}

}  // namespace
}  // namespace planemap::evaluation
