// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {
namespace {

TEST(RansacLeftOut, IsSaidInOneLine) {
    SegmentationOptions options;
    options.method = "ransac";
    EXPECT_THAT([&] { make_segmenter(options); },
                testing::ThrowsMessage<std::invalid_argument>(testing::AllOf(
                    testing::HasSubstr("without PCL"), testing::Not(testing::HasSubstr("\n")))));
    options.ransac.subsampling = 0;
    EXPECT_THAT([&] { make_segmenter(options); },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("subsampling")));
}

}  // namespace
}  // namespace planemap::segmentation
