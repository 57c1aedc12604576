// SPDX-License-Identifier: BSD-3-Clause
#include "report_page/point_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kProperties =
    "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nproperty int plane\n";

std::string header(const std::string& count, const std::string& properties = kProperties) {
    return "ply\nformat binary_little_endian 1.0\ncomment of a test\nelement vertex " + count + "\n" +
           properties + "end_header\n";
}

template <typename T>
std::string bytes_of(T value) {
    std::string bytes(sizeof(value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(value));
    return bytes;
}

std::string vertex(float x, int plane) {
    return bytes_of(x) + bytes_of(2.0F) + bytes_of(3.0F) + "\x0a\x14\x1e" + bytes_of(plane);
}

class PointFile : public testing::Test {
  protected:
    std::vector<CloudPoint> read(const std::string& bytes) {
        write_file(folder_ / "points.ply", bytes);
        return read_points(folder_ / "points.ply");
    }
    std::string error(const std::string& bytes) {
        return error_of([&] { read(bytes); });
    }
    TemporaryFolder folder_;
};

TEST_F(PointFile, GivesWhatWasWritten) {
    const std::vector<CloudPoint> points = read(header("2") + vertex(1, 7) + vertex(-4.5F, -1));
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[0].position, Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(points[0].color, (Rgb{10, 20, 30}));
    EXPECT_EQ(points[0].plane, 7);
    EXPECT_EQ(points[1].position.x(), -4.5F);
    EXPECT_EQ(points[1].plane, -1);
}

TEST_F(PointFile, PropertiesMayStandInAnyOrderWithOthers) {
    const std::string properties =
        "property int32 plane\nproperty double time\nproperty uint8 red\nproperty uint8 green\n"
        "property uint8 blue\nproperty float32 x\nproperty float32 y\nproperty float32 z\nelement face 0\n"
        "property list uchar int vertex_indices\n";
    const std::string vertex =
        bytes_of(5) + bytes_of(0.25) + "abc" + bytes_of(1.0F) + bytes_of(2.0F) + bytes_of(3.0F);
    const std::vector<CloudPoint> points = read(header("1", properties) + vertex);
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].plane, 5);
    EXPECT_EQ(points[0].position, Eigen::Vector3f(1, 2, 3));
}

TEST_F(PointFile, WhatIsNotFiniteIsLeftOutAndNoneIsNone) {
    EXPECT_TRUE(read(header("0")).empty());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(read(header("2") + vertex(nan, 1) + vertex(1, 1)).size(), 1U);
}

TEST_F(PointFile, SomethingElseIsOneLineThatNamesFileAndReason) {
    EXPECT_THAT(error("obj\n"), AllOf(HasSubstr("points.ply: "), HasSubstr("is no PLY file")));
    EXPECT_THAT(error(""), HasSubstr("is no PLY file"));
    EXPECT_THAT(error("ply\nformat ascii 1.0\n"), HasSubstr("is ascii, not binary_little_endian"));
    EXPECT_THAT(error("ply\nelement face 3\n"), HasSubstr("first element is face"));
    EXPECT_THAT(error("ply\nelement vertex 3\n"), HasSubstr("no end"));
    EXPECT_THAT(error(header("3") + vertex(1, 1)), HasSubstr("is cut short"));
    EXPECT_THAT(error(header("-3")), HasSubstr("no number of points"));
    EXPECT_THAT(error(header("99999999999999999999")), HasSubstr("no number of points"));
    EXPECT_THAT(error(header("5000001")), HasSubstr("more than the 5000000"));
    EXPECT_THAT(error(header("1", "property float x\n")), HasSubstr("has no property y"));
    EXPECT_THAT(error(header("1", "property double x\n")), HasSubstr("x is double, not float"));
    EXPECT_THAT(error(header("1", "property list uchar int x\n")), HasSubstr("type list"));
    EXPECT_THAT(error_of([&] { read_points(folder_ / "none.ply"); }), HasSubstr("none.ply"));
}

}  // namespace
}  // namespace planemap
