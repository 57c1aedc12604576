// SPDX-License-Identifier: BSD-3-Clause
#include "camera/fakenect.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/kinect_depth.hpp"
#include "core/files.hpp"

namespace planemap::camera {

namespace {

constexpr int kWidth = 640, kHeight = 480;

/// The device's clock has 60 MHz and 32 bits.
std::uint32_t ticks(std::int64_t utime) {
    return static_cast<std::uint32_t>(60 * static_cast<std::uint64_t>(utime));
}

/// "d-12.345678-740740680.pgm"
std::string file_name(char kind, std::int64_t utime, const char* extension) {
    char name[80];
    std::snprintf(name, sizeof(name), "%c-%" PRId64 ".%06" PRId64 "-%" PRIu32 ".%s", kind, utime / 1000000,
                  utime % 1000000, ticks(utime), extension);
    return name;
}

/// Little-endian, as libfreenect hands raw depth out, whatever a PGM says.
std::string depth_file(const DepthImage& depth, double units_per_metre) {
    std::string text = "P5 640 480 65535\n";
    for (const std::uint16_t reading : depth.pixels) {
        const double mm = is_valid_depth(reading) ? reading * 1000 / units_per_metre : 0;
        const std::uint16_t raw = mm_to_raw(static_cast<std::uint16_t>(std::min(mm + 0.5, 65534.0)));
        text += static_cast<char>(raw & 0xff);
        text += static_cast<char>(raw >> 8);
    }
    return text;
}

std::string color_file(const RgbImage& color) {
    std::string text = "P6 640 480 255\n";
    text.append(reinterpret_cast<const char*>(color.pixels.data()), 3 * color.pixels.size());
    return text;
}

/// The constants of raw_to_mm(), and a registration that leaves each pixel where it is.
std::string device_file() {
    return R"({
    "reg_info": {
        "ax": 0, "bx": 0, "cx": 0, "dx": 0, "ay": 0, "by": 0, "cy": 0, "dy": 0,
        "pad_info": {"start_lines": 0, "end_lines": 0, "cropping_lines": 0},
        "zero_plane_info": {"dcmos_emitter_distance": 7.5, "dcmos_rcmos_distance": 0,
                            "reference_distance": 120, "reference_pixel_size": 0.1042}
    },
    "const_shift": 200
}
)";
}

void require_kinect(const CameraInfo& camera) {
    const auto is_vga = [](const PinholeCamera& c) { return c.width == kWidth && c.height == kHeight; };
    if (!is_vga(camera.depth) || !is_vga(camera.color))
        throw std::invalid_argument(
            "a Kinect v1's images are 640x480; these are " + std::to_string(camera.depth.width) + "x" +
            std::to_string(camera.depth.height) + " and " + std::to_string(camera.color.width) + "x" +
            std::to_string(camera.color.height));
}

}  // namespace

std::size_t write_fakenect(FrameSource& source, const std::filesystem::path& folder, std::size_t max_frames,
                           const DecodeColor& decode) {
    require_kinect(source.camera());
    if (std::filesystem::exists(folder)) throw std::runtime_error(folder.string() + ": is there already");
    const std::filesystem::path beside = folder.string() + ".partial";
    std::filesystem::remove_all(beside);
    std::filesystem::create_directories(beside);
    std::string index;
    std::size_t frames = 0;
    const auto add = [&](const std::string& name, const std::string& bytes) {
        write_file(beside / name, bytes);
        index += name + "\n";
    };
    for (SensorFrame frame; max_frames == 0 || frames < max_frames;) {
        const ReadResult result = source.next(frame);
        if (result.status == ReadResult::Status::kEnd) break;
        if (result.status != ReadResult::Status::kFrame) continue;
        add(file_name('d', frame.utime, "pgm"),
            depth_file(frame.depth, source.camera().depth_units_per_metre));
        if (frame.color_utime != 0)
            add(file_name('r', frame.color_utime, "ppm"), color_file(decode(frame, source.camera().color)));
        ++frames;
    }
    write_file(beside / "INDEX.txt", index);
    write_file(beside / "device.json", device_file());
    std::filesystem::rename(beside, folder);
    return frames;
}

}  // namespace planemap::camera
