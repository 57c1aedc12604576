// SPDX-License-Identifier: BSD-3-Clause
#include "map/rules.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"

namespace planemap::map {
namespace {

TEST(Rules, AreTheOptions) {
    MapOptions options;
    options.merge_angle_deg = 7;
    options.pose_sigma_m = 0.011;
    options.outline_tolerance_m = 0.05;
    options.outline_cell_m = 0.1;
    options.adjacency_angle_deg = 20;
    options.infer_hidden = false;
    EXPECT_EQ(merge_rules(options).angle_rad, radians(7));
    EXPECT_EQ(merge_rules(options).gap_m, options.merge_gap_m);
    EXPECT_EQ(observation_model(options).pose_sigma_m, 0.011);
    EXPECT_EQ(derivation_rules(options).outline.tolerance_m, 0.05);
    EXPECT_EQ(derivation_rules(options).min_single_m2, options.min_single_m2);
    EXPECT_EQ(adjacency_rules(options).min_angle_rad, radians(20));
    EXPECT_NEAR(adjacency_rules(options).slack_m, 0.15, 1e-12) << "a cell and a half";
    EXPECT_FALSE(inference_rules(options).infers);
    EXPECT_EQ(inference_rules(options).cell_m, 0.1);
}

TEST(Rules, OfSurfacesAreNoneWhereThePapersAloneCount) {
    MapOptions options;
    options.pose_sigma_m = 0.011;
    ASSERT_TRUE(surface_rules(options));
    EXPECT_EQ(surface_rules(options)->pose_sigma_m, 0.011);
    options.rules = "paper";
    EXPECT_FALSE(surface_rules(options));
}

}  // namespace
}  // namespace planemap::map
