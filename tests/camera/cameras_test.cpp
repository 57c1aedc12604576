// SPDX-License-Identifier: BSD-3-Clause
// Inputs, USB cameras, the structure of .oni files, and a Kinect's raw depth.
#include "camera/cameras.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "camera/kinect_depth.hpp"
#include "camera/oni_file.hpp"
#include "camera/usb_cameras.hpp"
#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::camera {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

TEST(Cameras, InputsThatAreCameras) {
    for (const char* input :
         {"openni2", "openni2:1d27/0601@1/5", "openni2:1206120016", "freenect", "a/b.oni"})
        EXPECT_TRUE(is_camera(input)) << input;
    for (const char* input : {"", "openni", "openni22", "sim:office", "folder", "x.oni.log"})
        EXPECT_FALSE(is_camera(input)) << input;
}

TEST(Cameras, OptionsThatAreWrongAreNamed) {
    CameraOptions options;
    options.resolution = "640 by 480";
    options.exposure = -1;
    const std::string error = error_of([&] { options.validate(); });
    EXPECT_THAT(error, HasSubstr("resolution"));
    EXPECT_THAT(error, HasSubstr("exposure"));
}

TEST(UsbCameras, NoPermissionIsToldApartFromNoCamera) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(why_no_camera("openni2", usb_cameras(folder.path() / "none", folder.path())),
                HasSubstr("no camera"));
    const auto device = folder.path() / "sys/1-4";
    std::filesystem::create_directories(device);
    write_file(device / "idVendor", "1d27\n");
    write_file(device / "idProduct", "0601\n");
    write_file(device / "busnum", "1\n");
    write_file(device / "devnum", "4\n");
    const auto cameras = usb_cameras(folder.path() / "sys", folder.path() / "dev");
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_FALSE(cameras[0].may_open);
    const std::string why = why_no_camera("openni2", cameras);
    EXPECT_THAT(why, HasSubstr("no permission"));
    EXPECT_THAT(why, HasSubstr("dev/001/004"));
    EXPECT_THAT(why, HasSubstr("libopenni2-0"));
    EXPECT_THAT(why_no_camera("freenect", {{"Xtion", "openni2", {}, true, {}}}),
                HasSubstr("give openni2 as INPUT"));
}

TEST(OniFile, ForeignAndTruncatedFilesAreToldWithTheirPlace) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "x.oni";
    const std::string header("NI10\x01\x00\x01\x00\0\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0", 24);
    const std::string record("NIR\0\x0a\0\0\0\x01\0\0\0\x1c\0\0\0\x08\0\0\0\0\0\0\0\0\0\0\0", 28);
    const std::string end("NIR\0\x0b\0\0\0\0\0\0\0\x1c\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 28);
    const std::string good = header + record + "12345678" + end;
    write_file(file, good);
    EXPECT_NO_THROW(check_oni_file(file));
    for (std::size_t size = 0; size < good.size(); ++size) {
        write_file(file, good.substr(0, size));
        const std::string error = error_of([&] { check_oni_file(file); });
        EXPECT_THAT(error, HasSubstr("x.oni")) << size;
        EXPECT_THAT(error, HasSubstr(size < 24 ? "is no OpenNI recording" : "cut short")) << size;
    }
    write_file(file, header + std::string(100, 'x'));
    EXPECT_THAT(error_of([&] { check_oni_file(file); }), HasSubstr("damaged at byte 24"));
    write_file(file, "an LCM log, perhaps, but nothing of OpenNI's");
    EXPECT_THAT(error_of([&] { open_camera(file.string(), {}); }), HasSubstr("is no OpenNI recording"));
}

TEST(KinectDepth, RawReadingsAreTheNearestToTheirDistance) {
    EXPECT_EQ(raw_to_mm(kNoRawDepth), 0);
    EXPECT_EQ(mm_to_raw(0), kNoRawDepth);
    for (std::uint16_t mm = 500; mm < 5000; ++mm) {
        const std::uint16_t raw = mm_to_raw(mm);
        ASSERT_LT(raw, kNoRawDepth);
        const double step = raw_to_mm(static_cast<std::uint16_t>(raw + 1)) - raw_to_mm(raw);
        EXPECT_GE(step, 0) << "half a millimetre at 0.5 m";
        EXPECT_LE(std::abs(raw_to_mm(raw) - mm), 0.5 * step + 1) << mm;
    }
    EXPECT_NO_THROW(kinect_camera(true).validate());
    EXPECT_NO_THROW(kinect_camera(false).validate());
}

}  // namespace
}  // namespace planemap::camera
