// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "octomap/octomap_builder.hpp"

namespace planemap::octomap {
namespace {

using ::testing::HasSubstr;

TEST(OctomapOptions, NamesAllBadFields) {
    OctomapOptions options;
    options.resolution_m = 0;
    options.subsample = 0;
    try {
        OctomapBuilder{options};
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("resolution_m"));
        EXPECT_THAT(error.what(), HasSubstr("subsample"));
    }
}

}  // namespace
}  // namespace planemap::octomap
