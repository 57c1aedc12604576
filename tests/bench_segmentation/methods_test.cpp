// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/methods.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench_segmentation/metrics.hpp"
#include "bench_segmentation/two_walls.hpp"
#include "benchmark/decimation.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParseMethods, NamesAndSubsamplings) {
    EXPECT_THAT(parse_methods("ransac/4,cells"), ElementsAre(MethodName{"ransac", 4}, MethodName{"cells", 1},
                                                             MethodName{"cells", 2}, MethodName{"cells", 4}));
    EXPECT_THAT(test::error_of([] { parse_methods("hough"); }),
                AllOf(HasSubstr("hough"), HasSubstr("ransac")));
    for (const char* bad : {"cells/", "cells/0", "cells/17", "cells/x", "cells/2x", "cells/-1"})
        EXPECT_THAT(test::error_of([&] { parse_methods(bad); }), HasSubstr(bad));
    EXPECT_THAT(test::error_of([] { parse_methods(""); }), HasSubstr("none"));
}

TEST(SpreadLabels, EachPixelTakesItsNearestSamplesLabelIfItLiesOnThePlane) {
    TwoWalls walls;
    walls.depth(101, 101) = 500;  // far before the wall
    walls.depth(102, 101) = 0;
    const auto spread_out = spread(benchmark::decimated(walls.perfect.labels, 4), walls.perfect.regions,
                                   walls.depth, walls.camera, 4);
    int different = 0;
    for (std::size_t i = 0; i < spread_out.pixels.size(); ++i)
        different += spread_out.pixels[i] != walls.perfect.labels.pixels[i];
    EXPECT_EQ(spread_out(101, 101), 0);
    EXPECT_EQ(spread_out(102, 101), 0);
    EXPECT_LE(different, 4 * 480 + 2) << "only near the edge";
}

TEST(Methods, AllFindTheTwoWallsInAllSizes) {
    const TwoWalls walls;
    for (const MethodInfo& info : known_methods()) {
        for (const int step : {1, 2, 4}) {
            if (step == 1 && info.name == "ransac-debian") continue;  // takes seconds
            Method method({info.name, step});
            EXPECT_GT(method.run(walls.depth, walls.camera), 0);
            const segmentation::Segmentation& found = method.result(walls.depth, walls.camera);
            EXPECT_EQ(found.labels.width, 640);
            EXPECT_NE(scene::find(found, kWall1, 2, 10), nullptr) << info.name << '/' << step;
            EXPECT_NE(scene::find(found, kWall2, 2, 10), nullptr) << info.name << '/' << step;
            const MatchScore score = match(walls.truth, found, walls.depth, walls.camera, kLeastPixels);
            EXPECT_EQ(score.recalled, 2) << info.name << '/' << step;
        }
    }
}

TEST(Methods, BothBuildsOfRansacFindTheSame) {
    const TwoWalls walls;
    Method ours({"ransac", 4}), debian({"ransac-debian", 4});
    ours.run(walls.depth, walls.camera);
    debian.run(walls.depth, walls.camera);
    const segmentation::Segmentation a = ours.result(walls.depth, walls.camera),
                                     b = debian.result(walls.depth, walls.camera);
    ASSERT_EQ(a.regions.size(), b.regions.size());
    for (std::size_t i = 0; i < a.regions.size(); ++i)
        EXPECT_LT(angle_between(a.regions[i].plane.normal, b.regions[i].plane.normal), 1e-3);
}

TEST(Methods, AnImageWithoutReadingsGivesNothing) {
    const CameraInfo camera = scene::camera();
    const DepthImage empty(640, 480);
    for (const MethodInfo& info : known_methods()) {
        Method method({info.name, 4});
        method.run(empty, camera);
        EXPECT_TRUE(method.result(empty, camera).regions.empty()) << info.name;
    }
}

}  // namespace
}  // namespace planemap::bench
