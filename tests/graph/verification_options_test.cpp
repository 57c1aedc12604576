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

}  // namespace
}  // namespace planemap::graph
