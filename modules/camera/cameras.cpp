// SPDX-License-Identifier: BSD-3-Clause
#include "camera/cameras.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "camera/freenect_camera.hpp"
#include "camera/live_source.hpp"
#include "camera/oni_source.hpp"
#include "camera/openni2_camera.hpp"
#include "camera/usb_cameras.hpp"

namespace planemap::camera {

namespace {

bool is_oni(const std::string& input) {
    return std::filesystem::path(input).extension() == ".oni";
}

/// "SERIAL" of "openni2:SERIAL"; empty for "openni2"; nothing for another kind.
std::optional<std::string> wanted_of(const std::string& input, const std::string& kind) {
    if (input == kind) return std::string();
    if (input.starts_with(kind + ":")) return input.substr(kind.size() + 1);
    return std::nullopt;
}

/// Its drivers stay while the camera is away, to see it come back. A recording ends with the first opening.
std::unique_ptr<FrameSource> open_openni2(const std::string& wanted, const CameraRequest& request) {
    return std::make_unique<LiveSource>(
        [library = std::make_shared<OpenNi2Library>(), wanted, request,
         again = false](const std::string& serial) mutable -> std::unique_ptr<LiveCamera> {
            CameraRequest now = request;
            if (std::exchange(again, true)) now.record.clear();
            return std::make_unique<OpenNi2Camera>(serial.empty() ? wanted : serial, now);
        });
}

}  // namespace

bool is_camera(const std::string& input) {
    return wanted_of(input, "openni2") || wanted_of(input, "freenect") || is_oni(input);
}

std::unique_ptr<FrameSource> open_camera(const std::string& input, const CameraRequest& request) {
    request.options.validate();
    const std::optional<std::string> openni2 = wanted_of(input, "openni2");
    if (!request.record.empty() && !openni2) refuse_recording(input);
    if (openni2) return open_openni2(*openni2, request);
    if (const std::optional<std::string> freenect = wanted_of(input, "freenect")) {
        return std::make_unique<LiveSource>([=](const std::string&) -> std::unique_ptr<LiveCamera> {
            return std::make_unique<FreenectCamera>(*freenect, request);
        });
    }
    return std::make_unique<OniSource>(input, request);
}

void refuse_recording(const std::string& input) {
    throw std::invalid_argument("--record writes what an OpenNI2 camera sends; INPUT is " + input);
}

std::string list_cameras() {
    std::string text = list_openni2_cameras();
    if (has_freenect_camera())
        text +=
            "freenect  Kinect v1\n  depth: 640x480 at 30 Hz, 1 mm\n  colour: 640x480 at 30 Hz, RGB\n  "
            "registration: yes\n";
    for (const UsbCamera& camera : usb_cameras()) {
        if (camera.may_open && !camera.input.empty()) continue;
        text += camera.name + " at " + camera.node.string() + "\n  " +
                (camera.input.empty() ? std::string("planemap does not read it live")
                                      : why_no_camera(camera.input, {camera})) +
                "\n";
    }
    return text.empty() ? "no camera is plugged in\n" : text;
}

}  // namespace planemap::camera
