// SPDX-License-Identifier: BSD-3-Clause
#include "graph/verification_options.hpp"

#include <gtest/gtest.h>

namespace planemap::graph {
namespace {

TEST(VerificationOptions, TakesWhatTheGraphsOptionsSay) {
    GraphOptions options;
    options.matching_ratio = 0.61;
    options.min_inliers = 37;
    options.min_inlier_ratio = 0.43;
    const places::VerificationOptions verification = verification_options(options);
    EXPECT_EQ(verification.matching.ratio, 0.61);
    EXPECT_EQ(verification.min_inliers, 37);
    EXPECT_EQ(verification.min_inlier_ratio, 0.43);
}

/// A default that stands in both must be the same, or tests of verification would test another product.
TEST(VerificationOptions, ItsOwnDefaultsAreTheGraphs) {
    const places::VerificationOptions own, graphs = verification_options(GraphOptions());
    EXPECT_EQ(own.bearing_sigma, graphs.bearing_sigma);
    EXPECT_EQ(own.min_inliers, graphs.min_inliers);
    EXPECT_EQ(own.min_inlier_ratio, graphs.min_inlier_ratio);
    EXPECT_EQ(own.min_visible_ratio, graphs.min_visible_ratio);
    EXPECT_EQ(own.max_contradiction, graphs.max_contradiction);
    EXPECT_EQ(own.matching.max_distance, graphs.matching.max_distance);
    EXPECT_EQ(own.matching.ratio, graphs.matching.ratio);
}

}  // namespace
}  // namespace planemap::graph
