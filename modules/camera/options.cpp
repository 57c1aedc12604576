// SPDX-License-Identifier: BSD-3-Clause
#include "camera/options.hpp"

#include <cstdio>

namespace planemap::camera {

namespace {

/// "WxH" as two numbers, both 0 for anything else.
std::pair<int, int> size_of(const std::string& resolution) {
    int width = 0, height = 0, end = 0;
    const int read = std::sscanf(resolution.c_str(), "%4dx%4d%n", &width, &height, &end);
    if (read != 2 || end != static_cast<int>(resolution.size()) || width < 1 || height < 1) return {0, 0};
    return {width, height};
}

}  // namespace

int CameraOptions::width() const {
    return size_of(resolution).first;
}
int CameraOptions::height() const {
    return size_of(resolution).second;
}

void CameraOptions::validate() const {
    FieldErrors errors("camera");
    CameraOptions copy = *this;
    options_of(copy).check(errors);
    errors.require(width() > 0, "resolution", resolution, "WIDTHxHEIGHT in pixels, such as 640x480");
    errors.throw_if_any();
}

OptionList options_of(CameraOptions& options) {
    OptionList list("Camera");
    list.add("resolution", options.resolution, std::vector<std::string>{},
             "Of depth and colour, WIDTHxHEIGHT");
    list.add("rate", options.rate_hz, {1, 240, "Hz"}, "Frames a second that the camera takes");
    list.add("depth_unit", options.depth_unit, {"1mm", "100um"},
             "Of a depth reading, where the camera has both");
    list.add("registration", options.registration, {"auto", "on", "off"},
             "Depth at colour's pixels, done by the camera; auto: on, unless camera.json says otherwise");
    list.add(
        "frame_sync", options.frame_sync,
        "Depth and colour are taken at the same time, if the camera can; they are paired by their stamps "
        "in any case");
    list.add("exposure", options.exposure, {0, 1000000},
             "Of colour, in the camera's own units; 0: automatic");
    list.add("mirror", options.mirror, "Images as in a mirror; a map of them is mirrored, too");
    return list;
}

bool CameraRequest::wants_registration() const {
    if (options.registration != "auto") return options.registration == "on";
    return !described || described->registered;
}

}  // namespace planemap::camera
