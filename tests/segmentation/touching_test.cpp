// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/touching.hpp"

#include <gtest/gtest.h>

#include "segmentation/cell_map.hpp"

namespace planemap::segmentation {
namespace {

InverseDepthPlane flat(int, int) {
    return {0, 0, 0.5};
}

CellLinks links_of(const OwnedMap& owned) {
    CellLinks links;
    links.find(owned.map(), 0.006, 1.5);
    return links;
}

std::vector<Touch> touching(const OwnedMap& owned, const CellRegions& cell_regions) {
    TouchList list;
    find_touching(owned.map(), links_of(owned), cell_regions, list);
    MergedLabels separate(cell_regions.regions.size() + 1);
    list.gather(separate);
    return list.entries();
}

TEST(TouchingTest, RegionsSideBySideTouchAlongTheirBorder) {
    const OwnedMap owned = make_map(10, 6, flat);
    const std::vector<Touch> touches =
        touching(owned, make_regions(owned, [](int x, int) { return x < 5 ? 1 : 2; }));
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_EQ(touches[0].a, 1);
    EXPECT_EQ(touches[0].b, 2);
    EXPECT_EQ(touches[0].side_by_side, 6);
    EXPECT_EQ(touches[0].linked, 6);
}

TEST(TouchingTest, ANarrowGapIsLookedOverAndAWideOneIsNot) {
    const OwnedMap owned = make_map(12, 3, flat);
    for (const int gap : {1, 4, 5}) {
        const auto touches = touching(owned, make_regions(owned, [=](int x, int) {
                                          return x < 3 ? 1 : x < 3 + gap ? 0 : 2;
                                      }));
        ASSERT_EQ(touches.size(), gap <= 4 ? 1u : 0u) << gap;
        if (!touches.empty()) {
            EXPECT_EQ(touches[0].side_by_side, 0);
        }
    }
}

TEST(TouchingTest, OneRegionOrNoneTouchesNothing) {
    const OwnedMap owned = make_map(10, 6, flat);
    EXPECT_TRUE(touching(owned, make_regions(owned, [](int, int) { return 1; })).empty());
    EXPECT_TRUE(touching(owned, make_regions(owned, [](int, int) { return 0; })).empty());
    EXPECT_TRUE(touching(OwnedMap{}, CellRegions{}).empty());
}

CellRegions without_thin(const OwnedMap& owned, CellRegions cell_regions) {
    ThinRegions thin;
    thin.remove(owned.map(), links_of(owned), {0.015, 3, owned.map().noise}, cell_regions);
    return cell_regions;
}

TEST(ThinRegionsTest, AChainBesideARegionWhoseBandHoldsItGoes) {
    const auto wall_with_strip = [](double strip_m) {
        return make_map(20, 15, [=](int x, int) {
            return InverseDepthPlane{0, 0, 1 / (x == 10 ? 1.5 + strip_m : 1.5)};
        });
    };
    const auto label = [](int x, int) { return x < 10 ? 1 : x == 10 ? 2 : 0; };
    OwnedMap owned = wall_with_strip(0.004);
    EXPECT_EQ(without_thin(owned, make_regions(owned, label)).at(2).cells, 0) << "noise";
    owned = wall_with_strip(0.1);
    EXPECT_EQ(without_thin(owned, make_regions(owned, label)).at(2).cells, 15) << "something else";
}

TEST(ThinRegionsTest, WideRegionsStay) {
    const OwnedMap owned = make_map(20, 15, flat);
    const CellRegions two =
        without_thin(owned, make_regions(owned, [](int x, int) { return x < 10 ? 1 : 2; }));
    EXPECT_EQ(two.at(1).cells, 150);
    EXPECT_EQ(two.at(2).cells, 150);
    EXPECT_NO_THROW(without_thin(OwnedMap{}, CellRegions{}));
}

}  // namespace
}  // namespace planemap::segmentation
