// SPDX-License-Identifier: BSD-3-Clause
#include "core/camera.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "core/validation.hpp"

namespace planemap {

namespace {

void check(const PinholeCamera& camera, const std::string& name, FieldErrors& errors) {
    constexpr int kMaxSide = 8192;
    const auto size = [&](int value, const char* field) {
        errors.require(value >= 1 && value <= kMaxSide, name + field, value, "1 to 8192");
    };
    const auto focal = [&](double value, const char* field) {
        errors.require(std::isfinite(value) && value > 0, name + field, value, "finite and greater than 0");
    };
    const auto centre = [&](double value, const char* field) {
        errors.require(std::isfinite(value), name + field, value, "finite");
    };
    size(camera.width, ".width");
    size(camera.height, ".height");
    focal(camera.fx, ".fx");
    focal(camera.fy, ".fy");
    centre(camera.cx, ".cx");
    centre(camera.cy, ".cy");
}

/// Registration is for images of comparable resolution: beyond, a pixel of one camera is a blot on the
/// other's image, and such numbers are more often a mistake than a sensor.
void check_ratio(double depth, double color, const std::string& field, FieldErrors& errors) {
    constexpr double kLeast = 0.3, kMost = 4;
    if (!(depth > 0 && color > 0 && std::isfinite(depth) && std::isfinite(color))) return;
    if (depth >= kLeast * color && depth <= kMost * color) return;
    std::ostringstream value;
    value << depth / color << " (" << depth << " / " << color << " pixels)";
    errors.require(false, "depth." + field + " / color." + field, value.str(),
                   "0.3 to 4 for depth to be registered to colour");
}

}  // namespace

void check_depth(const DepthNoise& noise, double min_m, double max_m, FieldErrors& errors) {
    errors.require(min_m >= 0, "depth_min_m", min_m, "at least 0");
    errors.require(std::isfinite(max_m) && max_m > min_m, "depth_max_m", max_m,
                   "finite and greater than depth_min_m");
    errors.require(noise.base_m >= 0 && noise.base_m <= 1, "noise.base_m", noise.base_m, "0 to 1");
    errors.require(noise.quadratic_per_m >= 0 && noise.quadratic_per_m <= 1, "noise.quadratic_per_m",
                   noise.quadratic_per_m, "0 to 1");
    errors.require(std::abs(noise.offset_m) <= 100, "noise.offset_m", noise.offset_m, "-100 to 100");
}

void CameraInfo::validate() const {
    FieldErrors errors("camera info");
    if (serial.size() > 64)
        errors.require(false, "serial", serial.substr(0, 64) + "...", "at most 64 characters");
    check(depth, "depth", errors);
    check(color, "color", errors);
    check_ratio(depth.fx, color.fx, "fx", errors);
    check_ratio(depth.fy, color.fy, "fy", errors);
    errors.require(is_valid(color_from_depth), "color_from_depth", "not a rigid transform",
                   "a rigid transform");
    errors.require(std::isfinite(depth_units_per_metre) && depth_units_per_metre > 0, "depth_units_per_metre",
                   depth_units_per_metre, "finite and greater than 0");
    check_depth(noise, depth_min_m, depth_max_m, errors);
    errors.throw_if_any();
}

bool operator==(const CameraInfo& a, const CameraInfo& b) {
    return a.serial == b.serial && a.depth == b.depth && a.color == b.color && a.registered == b.registered &&
           a.color_from_depth.matrix() == b.color_from_depth.matrix() &&
           a.depth_units_per_metre == b.depth_units_per_metre && a.depth_min_m == b.depth_min_m &&
           a.depth_max_m == b.depth_max_m && a.noise == b.noise;
}

}  // namespace planemap
