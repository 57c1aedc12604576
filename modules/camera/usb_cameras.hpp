// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace planemap::camera {

/// A depth camera on USB that the kernel sees, whether or not somebody may open it.
struct UsbCamera {
    std::string name;            ///< "Kinect of the Xbox 360"
    std::string input;           ///< the INPUT that reads it: "openni2" or "freenect"; empty: none of ours
    std::filesystem::path node;  ///< /dev/bus/usb/001/004
    bool may_open = false;       ///< this process may read and write the node
    std::string package;         ///< whose udev rules let users open it
};

/// The cameras that planemap knows by their USB ids. The arguments are for tests.
std::vector<UsbCamera> usb_cameras(const std::filesystem::path& sysfs = "/sys/bus/usb/devices",
                                   const std::filesystem::path& nodes = "/dev/bus/usb");

/// What to say when `input` finds no camera that it can open: that none is plugged in, that one is which
/// this user may not open and how that is changed, or that one is for the other input. One line.
std::string why_no_camera(const std::string& input, const std::vector<UsbCamera>& cameras);

}  // namespace planemap::camera
