// SPDX-License-Identifier: BSD-3-Clause
#include "core/nearest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace planemap {
namespace {

const std::vector<std::string> kNames{"output",       "color_camera", "depth_camera", "rate",
                                      "azure_kinect", "kinect1",      "kinect2",      "max-frames"};

TEST(NearestName, ForgivesOneLetterInThree) {
    EXPECT_EQ(nearest_name("outptu", kNames), "output") << "neighbours swapped";
    EXPECT_EQ(nearest_name("colour_camera", kNames), "color_camera") << "one more";
    EXPECT_EQ(nearest_name("detph_camra", kNames), "depth_camera") << "swapped, and one less";
    EXPECT_EQ(nearest_name("rats", kNames), "rate") << "replaced";
    EXPECT_EQ(nearest_name("kinect_v2", kNames), "kinect2");
    EXPECT_EQ(nearest_name("output", kNames), "output");
}

TEST(NearestName, CaseAndDashesDoNotCount) {
    EXPECT_EQ(nearest_name("Max_Frames", kNames), "max-frames");
    EXPECT_EQ(nearest_name("DEPTH-CAMERA", kNames), "depth_camera");
}

TEST(NearestName, TheStartOfANameIsEnough) {
    EXPECT_EQ(nearest_name("azure", kNames), "azure_kinect");
    EXPECT_EQ(nearest_name("max", kNames), "max-frames");
    EXPECT_EQ(nearest_name("az", kNames), "") << "two letters say nothing";
}

TEST(NearestName, OfEquallyNearNamesTheFirst) {
    EXPECT_EQ(nearest_name("kinect", kNames), "kinect1");
    EXPECT_EQ(nearest_name("kinect3", kNames), "kinect1");
}

TEST(NearestName, NothingNearIsEmpty) {
    EXPECT_EQ(nearest_name("", kNames), "");
    EXPECT_EQ(nearest_name("serial", kNames), "");
    EXPECT_EQ(nearest_name("x", kNames), "");
    EXPECT_EQ(nearest_name("output", {}), "");
    EXPECT_EQ(nearest_name(std::string(1000000, 'o'), kNames), "");
    EXPECT_EQ(nearest_name(std::string("\xff\0\x01", 3), kNames), "");
}

}  // namespace
}  // namespace planemap
