// SPDX-License-Identifier: BSD-3-Clause
#include "camera/kinect_depth.hpp"

#include <array>
#include <cmath>

#include "core/image.hpp"

namespace planemap::camera {

namespace {

constexpr double kEmitter_cm = 7.5, kZeroPlane_cm = 120, kPixel_cm = 0.1042;
constexpr double kConstShift = 200, kSteps = 4, kOffset_px = 0.375, kMaxDepth_mm = 10000;

double mm_of(double raw) {
    const double shift_px = (raw - kSteps * kConstShift) / kSteps - kOffset_px;
    const double shift_cm = shift_px * kPixel_cm;
    return 10 * (shift_cm * kZeroPlane_cm / (kEmitter_cm - shift_cm) + kZeroPlane_cm);
}

std::array<std::uint16_t, 2048> make_table() {
    std::array<std::uint16_t, 2048> table{};
    for (std::size_t raw = 0; raw < kNoRawDepth; ++raw) {
        const double mm = mm_of(static_cast<double>(raw));
        table[raw] =
            mm > 0 && mm < kMaxDepth_mm ? static_cast<std::uint16_t>(std::lround(mm)) : std::uint16_t{0};
    }
    return table;
}

}  // namespace

std::uint16_t raw_to_mm(std::uint16_t raw) {
    static const std::array<std::uint16_t, 2048> table = make_table();
    return raw < table.size() ? table[raw] : std::uint16_t{0};
}

std::uint16_t mm_to_raw(std::uint16_t mm) {
    if (!is_valid_depth(mm) || mm >= kMaxDepth_mm) return kNoRawDepth;
    const double cm = 0.1 * mm;
    const double shift_px = kEmitter_cm * (cm - kZeroPlane_cm) / cm / kPixel_cm;
    const long raw = std::lround(kSteps * (shift_px + kOffset_px) + kSteps * kConstShift);
    return raw >= 0 && raw < kNoRawDepth ? static_cast<std::uint16_t>(raw) : kNoRawDepth;
}

CameraInfo kinect_camera(bool is_registered) {
    CameraInfo camera;
    camera.serial = "Kinect v1";
    camera.color = {640, 480, 525, 525, 319.5, 239.5};
    const double focal_px = 0.5 * kZeroPlane_cm / kPixel_cm;  // the constants are of twice the size
    camera.depth = is_registered ? camera.color : PinholeCamera{640, 480, focal_px, focal_px, 319.5, 239.5};
    camera.registered = is_registered;
    if (!is_registered) camera.color_from_depth.translation().x() = -0.025;
    camera.depth_units_per_metre = 1000;
    return camera;
}

}  // namespace planemap::camera
