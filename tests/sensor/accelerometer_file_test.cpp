// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/accelerometer_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/camera_file.hpp"
#include "sensor/dataset.hpp"
#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::HasSubstr;

constexpr const char* kCamera = R"({"depth_camera": {"width": 16, "height": 12, "fx": 20, "fy": 20, "cx": 8,
    "cy": 6}, "depth_units_per_metre": 1000)";

TEST(AccelerometerFile, ReadsWhatATumFolderHas) {
    const test::TemporaryFolder folder;
    folder.write("accelerometer.txt",
                 "# accelerometer data\n# timestamp ax ay az\n2.5 0.1 8.2 -5.1\r\n\n1.5,0,9.8,0\n");
    const auto readings =
        read_accelerometer_file(folder.path() / "accelerometer.txt", Eigen::Matrix3d::Identity());
    ASSERT_EQ(readings.size(), 2u);
    EXPECT_EQ(readings[0].utime, 1500000);
    EXPECT_EQ(readings[1].acceleration_camera, Eigen::Vector3d(0.1, 8.2, -5.1));
}

TEST(AccelerometerFile, IsOfAKinectUnlessCameraJsonSaysOtherwise) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "camera.json";
    // Looking level, up is against the image's y; looking down, partly against the view.
    EXPECT_EQ(camera_from_accelerometer(file) * Eigen::Vector3d(0, 9.8, -1), Eigen::Vector3d(0, -9.8, -1));
    folder.write("camera.json", std::string(kCamera) +
                                    R"(, "camera_from_accelerometer": {"rotation_vector_rad": [0, 0, 0]}})");
    EXPECT_TRUE(camera_from_accelerometer(file).isIdentity(1e-12));
    read_camera_file(file);
    folder.write("camera.json",
                 std::string(kCamera) + R"(, "camera_from_accelerometer": {"rotation_vector_rad": [0, 9]}})");
    EXPECT_THROW(camera_from_accelerometer(file), std::invalid_argument);
    EXPECT_THROW(read_camera_file(file), std::invalid_argument);
}

TEST(AccelerometerFile, SaysWhichLineIsNone) {
    const test::TemporaryFolder folder;
    for (const char* line : {"1.5 0 9.8", "1.5 0 9.8 nan", "x 0 9.8 0", "1.5 0 9.8 1e9"}) {
        folder.write("accelerometer.txt", std::string("1.0 0 9.8 0\n") + line + "\n");
        try {
            read_accelerometer_file(folder.path() / "accelerometer.txt", Eigen::Matrix3d::Identity());
            ADD_FAILURE() << line;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), HasSubstr("accelerometer.txt:2: "));
        }
    }
}

TEST(AccelerometerFile, ItsReadingsComeWithTheFramesAfterThem) {
    const test::TemporaryFolder folder;
    folder.write("camera.json", std::string(kCamera) + "}");
    folder.write("depth/1.png", encode_depth_png(numbered_depth(16, 12)));
    folder.write("depth.txt", "10.0 depth/1.png\n11.0 depth/1.png\n");
    folder.write("accelerometer.txt", "8 0 9.8 0\n9.5 0 9.8 0\n10 0 9.8 0\n10.5 0 9.8 0\n12 0 9.8 0\n");
    Dataset dataset(folder.path());
    SensorFrame frame;
    dataset.next(frame);
    ASSERT_EQ(frame.accelerations.size(), 2u) << "those long before the first frame are not of it";
    EXPECT_EQ(frame.accelerations[0].utime, 9500000);
    EXPECT_EQ(frame.accelerations[0].acceleration_camera, Eigen::Vector3d(0, -9.8, 0));
    dataset.next(frame);
    ASSERT_EQ(frame.accelerations.size(), 1u);
    folder.write("accelerometer.txt", "8 0 9.8\n");
    Dataset broken(folder.path());
    EXPECT_EQ(broken.notes().size(), 2u) << "of the missing colour, and of this";
    EXPECT_THAT(broken.notes().back(), HasSubstr("the accelerometer is not used"));
    EXPECT_EQ(broken.next(frame).status, ReadResult::Status::kFrame);
}

}  // namespace
}  // namespace planemap::sensor
