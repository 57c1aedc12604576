// SPDX-License-Identifier: BSD-3-Clause
#include "camera/openni2_device.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "core/yuv.hpp"

namespace planemap::camera {

namespace {

using openni::PixelFormat;

/// Between depth and colour of PrimeSense's design, metres.
constexpr double kBaseline_m = 0.025;

PinholeCamera pinhole(const openni::VideoStream& stream) {
    const openni::VideoMode mode = stream.getVideoMode();
    const int width = mode.getResolutionX(), height = mode.getResolutionY();
    const auto focal = [](int pixels, float fov) {
        return 0.5 * pixels / std::tan(0.5 * static_cast<double>(fov));
    };
    return {width,
            height,
            focal(width, stream.getHorizontalFieldOfView()),
            focal(height, stream.getVerticalFieldOfView()),
            0.5 * (width - 1),
            0.5 * (height - 1)};
}

/// The same camera, its image of another size.
PinholeCamera scaled(const PinholeCamera& camera, int width, int height) {
    const double x = static_cast<double>(width) / camera.width,
                 y = static_cast<double>(height) / camera.height;
    return {width,
            height,
            x * camera.fx,
            y * camera.fy,
            x * (camera.cx + 0.5) - 0.5,
            y * (camera.cy + 0.5) - 0.5};
}

double units_per_metre(const openni::VideoStream& depth) {
    return depth.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM ? 10000 : 1000;
}

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

/// The description, if it can be of these streams.
CameraInfo described(const CameraInfo& camera, const openni::VideoStream& depth,
                     const openni::VideoStream* color, bool is_registered) {
    FieldErrors errors("camera.json is of another camera");
    const auto require_size = [&](const char* field, const PinholeCamera& said,
                                  const openni::VideoStream& stream) {
        const openni::VideoMode mode = stream.getVideoMode();
        const bool same = said.width == mode.getResolutionX() && said.height == mode.getResolutionY();
        errors.require(same, field, size_text(said.width, said.height),
                       "what it sends: " + size_text(mode.getResolutionX(), mode.getResolutionY()));
    };
    require_size("depth_camera", camera.depth, depth);
    if (color != nullptr) require_size("color_camera", camera.color, *color);
    errors.require(camera.depth_units_per_metre == units_per_metre(depth), "depth_units_per_metre",
                   camera.depth_units_per_metre, "what it sends: " + number_text(units_per_metre(depth)));
    errors.require(color == nullptr || camera.registered == is_registered, "registered",
                   std::string(camera.registered ? "true" : "false"),
                   std::string("what it does: ") + (is_registered ? "true" : "false"));
    errors.throw_if_any();
    return camera;
}

}  // namespace

OpenNi2Library::OpenNi2Library() {
    if (openni::OpenNI::initialize() != openni::STATUS_OK)
        throw std::runtime_error("OpenNI2 does not start: " + openni2_error());
}
OpenNi2Library::~OpenNi2Library() {
    openni::OpenNI::shutdown();
}

std::string openni2_error() {
    std::string text = openni::OpenNI::getExtendedError();
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "no reason is given" : text.substr(first, last - first + 1);
}

bool is_color_format(PixelFormat format) {
    return format == openni::PIXEL_FORMAT_RGB888 || format == openni::PIXEL_FORMAT_YUV422 ||
           format == openni::PIXEL_FORMAT_YUYV || format == openni::PIXEL_FORMAT_GRAY8;
}

DepthImage depth_image(const openni::VideoFrameRef& frame) {
    DepthImage image(frame.getWidth(), frame.getHeight());
    const auto* bytes = static_cast<const std::uint8_t*>(frame.getData());
    for (int v = 0; v < image.height; ++v) {
        std::memcpy(image.row(v), bytes + static_cast<std::ptrdiff_t>(v) * frame.getStrideInBytes(),
                    sizeof(std::uint16_t) * static_cast<std::size_t>(image.width));
    }
    return image;
}

RgbImage color_image(const openni::VideoFrameRef& frame) {
    RgbImage image(frame.getWidth(), frame.getHeight());
    const PixelFormat format = frame.getVideoMode().getPixelFormat();
    const bool luma_first = format == openni::PIXEL_FORMAT_YUYV;
    for (int v = 0; v < image.height; ++v) {
        const std::uint8_t* const row = static_cast<const std::uint8_t*>(frame.getData()) +
                                        static_cast<std::ptrdiff_t>(v) * frame.getStrideInBytes();
        Rgb* const out = image.row(v);
        for (std::ptrdiff_t u = 0; u < image.width; ++u) {
            if (format == openni::PIXEL_FORMAT_RGB888) {
                out[u] = {row[3 * u], row[3 * u + 1], row[3 * u + 2]};
            } else if (format == openni::PIXEL_FORMAT_GRAY8) {
                out[u] = {row[u], row[u], row[u]};
            } else {  // four bytes for two pixels: U Y V Y, or Y U Y V
                const std::uint8_t* const two = row + 4 * (u / 2);
                out[u] = luma_first ? rgb_of_yuv(two[2 * (u % 2)], two[1], two[3])
                                    : rgb_of_yuv(two[2 * (u % 2) + 1], two[0], two[2]);
            }
        }
    }
    return image;
}

std::string mode_text(const openni::VideoMode& mode) {
    const auto format = [&]() -> std::string {
        switch (mode.getPixelFormat()) {
            case openni::PIXEL_FORMAT_DEPTH_1_MM:
                return "1 mm";
            case openni::PIXEL_FORMAT_DEPTH_100_UM:
                return "100 um";
            case openni::PIXEL_FORMAT_RGB888:
                return "RGB";
            case openni::PIXEL_FORMAT_YUV422:
                return "YUV 4:2:2";
            case openni::PIXEL_FORMAT_YUYV:
                return "YUYV";
            case openni::PIXEL_FORMAT_GRAY8:
                return "grey";
            case openni::PIXEL_FORMAT_JPEG:
                return "JPEG";
            default:
                return "pixel format " + std::to_string(mode.getPixelFormat());
        }
    };
    return size_text(mode.getResolutionX(), mode.getResolutionY()) + " at " + std::to_string(mode.getFps()) +
           " Hz, " + format();
}

CameraInfo camera_info(const std::string& name, const openni::VideoStream& depth,
                       const openni::VideoStream* color, bool is_registered, const CameraRequest& request,
                       std::vector<std::string>& notes) {
    if (request.described) return described(*request.described, depth, color, is_registered);
    CameraInfo camera;
    camera.serial = name.substr(0, 64);
    camera.depth = pinhole(depth);
    camera.color = color == nullptr ? camera.depth : pinhole(*color);
    camera.registered = true;
    if (color != nullptr && is_registered) {
        camera.depth = scaled(camera.color, camera.depth.width, camera.depth.height);
        camera.registered = camera.depth == camera.color;
    } else if (color != nullptr) {
        camera.registered = false;
        camera.color_from_depth.translation().x() = -kBaseline_m;
        notes.push_back(name +
                        ": depth is not registered to colour; colour is taken to be 25 mm beside it, as in "
                        "PrimeSense's design: give --camera camera.json with what was calibrated");
    }
    camera.depth_units_per_metre = units_per_metre(depth);
    camera.depth_max_m =
        std::min(camera.depth_max_m, std::floor(65534 / camera.depth_units_per_metre * 10) / 10);
    camera.validate();
    return camera;
}

}  // namespace planemap::camera
