// SPDX-License-Identifier: BSD-3-Clause
#include "camera/usb_cameras.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace planemap::camera {

namespace {

struct Known {
    const char* vendor;
    const char* product;  ///< empty: all of the vendor's
    const char* name;
    const char* input;
    const char* package;
};
constexpr std::array<Known, 6> kKnown{{
    {"045e", "02ae", "Kinect of the Xbox 360", "freenect", "libfreenect0.5"},
    {"045e", "02bf", "Kinect for Windows", "freenect", "libfreenect0.5"},
    {"045e", "02c4", "Kinect v2", "", ""},
    {"1d27", "", "PrimeSense camera (Xtion, Carmine)", "openni2", "libopenni2-0"},
    {"2bc5", "", "Orbbec camera", "openni2", "libopenni2-0"},
    {"8086", "0b07", "RealSense D435", "", ""},
}};

std::string read_word(const std::filesystem::path& file) {
    std::string word;
    std::ifstream(file) >> word;
    return word;
}

/// "/dev/bus/usb/001/004"
std::filesystem::path node_of(const std::filesystem::path& device, const std::filesystem::path& nodes) {
    char name[32];
    std::snprintf(name, sizeof(name), "%03d/%03d", std::atoi(read_word(device / "busnum").c_str()),
                  std::atoi(read_word(device / "devnum").c_str()));
    return nodes / name;
}

}  // namespace

std::vector<UsbCamera> usb_cameras(const std::filesystem::path& sysfs, const std::filesystem::path& nodes) {
    std::vector<UsbCamera> cameras;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(sysfs, none)) {
        const std::string vendor = read_word(entry.path() / "idVendor"),
                          product = read_word(entry.path() / "idProduct");
        const auto known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) {
            return vendor == k.vendor && (*k.product == '\0' || product == k.product);
        });
        if (known == kKnown.end()) continue;
        const std::filesystem::path node = node_of(entry.path(), nodes);
        cameras.push_back(
            {known->name, known->input, node, access(node.c_str(), R_OK | W_OK) == 0, known->package});
    }
    std::sort(cameras.begin(), cameras.end(),
              [](const UsbCamera& a, const UsbCamera& b) { return a.node < b.node; });
    return cameras;
}

std::string why_no_camera(const std::string& input, const std::vector<UsbCamera>& cameras) {
    for (const UsbCamera& camera : cameras) {
        if (camera.input == input && !camera.may_open) {
            return "no permission: " + camera.name + " is plugged in, but this user may not open " +
                   camera.node.string() + "; the udev rules of the package " + camera.package +
                   " allow it once they are installed and the camera is plugged in again";
        }
    }
    for (const UsbCamera& camera : cameras) {
        if (camera.input == input)
            return camera.name + " is plugged in, but cannot be opened: another program may have it";
    }
    for (const UsbCamera& camera : cameras) {
        if (!camera.input.empty())
            return "no camera that it drives; " + camera.name + " is plugged in: give " + camera.input +
                   " as INPUT";
    }
    for (const UsbCamera& camera : cameras)
        return "no camera that it drives; " + camera.name +
               " is plugged in, which planemap does not read live";
    return "no camera is plugged in; planemap-sensor --list shows what there is";
}

}  // namespace planemap::camera
