// SPDX-License-Identifier: BSD-3-Clause
#include "core/camera.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "core/lens_distortion.hpp"
#include "core/number_text.hpp"
#include "core/validation.hpp"

namespace planemap {

namespace {

std::string range_text(double low, double high, const char* unit) {
    return short_number_text(low) + " to " + short_number_text(high) + unit;
}

void check(const PinholeCamera& camera, const std::string& name, FieldErrors& errors) {
    using Limits = CameraLimits;
    constexpr int kMaxSide = 8192;
    const auto within = [&](double value, double low, double high, const char* field, const char* unit) {
        if (!(value >= low && value <= high))  // words cost memory, and cameras are checked every frame
            errors.require(false, name + field, value, range_text(low, high, unit));
    };
    within(camera.width, 1, kMaxSide, ".width", "");
    within(camera.height, 1, kMaxSide, ".height", "");
    const double width = std::clamp(camera.width, 1, kMaxSide),
                 height = std::clamp(camera.height, 1, kMaxSide);
    const double longer = std::max(width, height);
    const double least = Limits::kLeastFocal * longer, most = Limits::kMostFocal * longer;
    within(camera.fx, least, most, ".fx", " pixels");
    within(camera.fy, least, most, ".fy", " pixels");
    within(camera.cx, -Limits::kOutside * width, (1 + Limits::kOutside) * width, ".cx", " pixels");
    within(camera.cy, -Limits::kOutside * height, (1 + Limits::kOutside) * height, ".cy", " pixels");
    const double aspect = camera.fx / camera.fy;
    if (!(camera.fx > 0 && camera.fy > 0 && std::isfinite(aspect))) return;
    if (aspect >= Limits::kLeastAspect && aspect <= Limits::kMostAspect) return;
    errors.require(false, name + ".fx / " + name + ".fy",
                   short_number_text(aspect) + " (" + short_number_text(camera.fx) + " / " +
                       short_number_text(camera.fy) + " pixels)",
                   range_text(Limits::kLeastAspect, Limits::kMostAspect, ""));
}

void check(const DepthCorrection& correction, FieldErrors& errors) {
    constexpr double kMost = DepthCorrection::kMost_per_m;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i) {
        const double offset = correction.offsets[i], sigma = correction.sigmas[i];
        if (!(std::abs(offset) <= kMost))
            errors.require(false, "depth_correction.offsets_per_m", offset,
                           range_text(-kMost, kMost, " per m"));
        if (!(sigma >= 0 && sigma <= kMost))
            errors.require(false, "depth_correction.sigmas_per_m", sigma, range_text(0, kMost, " per m"));
    }
}

/// That 16 bits reach into the depth range.
void check_units(const CameraInfo& camera, FieldErrors& errors) {
    using Limits = CameraLimits;
    const double units = camera.depth_units_per_metre;
    const bool units_good = units >= Limits::kLeastUnits && units <= Limits::kMostUnits;
    if (!units_good)
        errors.require(false, "depth_units_per_metre", units,
                       range_text(Limits::kLeastUnits, Limits::kMostUnits, ""));
    const double farthest = 65535 / units;
    if (units_good && camera.depth_min_m >= 0 && farthest <= camera.depth_min_m) {
        errors.require(false, "depth_units_per_metre", units,
                       "such that 16 bits reach beyond depth_min_m, " +
                           short_number_text(camera.depth_min_m) + " m: they end at " +
                           short_number_text(farthest) + " m");
    }
}

void check_lenses(const CameraInfo& camera, FieldErrors& errors) {
    if (camera.depth_distortion)
        check_distortion(*camera.depth_distortion, camera.depth, "depth.distortion", errors);
    if (camera.color_distortion)
        check_distortion(*camera.color_distortion, camera.color, "color.distortion", errors);
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
    const bool good[] = {std::isfinite(noise.base_m) && noise.base_m >= 0,
                         std::isfinite(noise.quadratic_per_m) && noise.quadratic_per_m >= 0,
                         std::isfinite(noise.offset_m)};
    errors.require(good[0], "noise.base_m", noise.base_m, "at least 0");
    errors.require(good[1], "noise.quadratic_per_m", noise.quadratic_per_m, "at least 0");
    errors.require(good[2], "noise.offset_m", noise.offset_m, "finite");
    if (!(good[0] && good[1] && good[2] && min_m < max_m && std::isfinite(max_m))) return;
    const double quietest = std::clamp(noise.offset_m, min_m, max_m);
    if (!(noise.sigma(quietest) >= CameraLimits::kLeastSigma_m)) {
        errors.require(
            false, "noise at " + short_number_text(quietest) + " m", noise.sigma(quietest),
            "at least " + short_number_text(CameraLimits::kLeastSigma_m) + " m (base_m, quadratic_per_m)");
    }
    const double loudest = std::max(noise.sigma(min_m), noise.sigma(max_m));
    if (!(loudest <= max_m)) {
        errors.require(false, "noise within the depth range", loudest,
                       "at most its far end, " + short_number_text(max_m) + " m");
    }
}

void CameraInfo::validate() const {
    FieldErrors errors("camera info");
    if (serial.size() > 64)
        errors.require(false, "serial", serial.substr(0, 64) + "...", "at most 64 characters");
    check(depth, "depth", errors);
    check(color, "color", errors);
    check_lenses(*this, errors);
    check_ratio(depth.fx, color.fx, "fx", errors);
    check_ratio(depth.fy, color.fy, "fy", errors);
    errors.require(is_valid(color_from_depth), "color_from_depth", "not a rigid transform",
                   "a rigid transform");
    errors.require(!body_from_camera || is_valid(*body_from_camera), "body_from_camera",
                   "not a rigid transform", "a rigid transform");
    if (depth_correction) check(*depth_correction, errors);
    check_units(*this, errors);
    check_depth(noise, depth_min_m, depth_max_m, errors);
    errors.throw_if_any();
}

bool operator==(const CameraInfo& a, const CameraInfo& b) {
    return a.serial == b.serial && a.depth == b.depth && a.color == b.color && a.registered == b.registered &&
           a.depth_distortion == b.depth_distortion && a.color_distortion == b.color_distortion &&
           a.color_from_depth.matrix() == b.color_from_depth.matrix() &&
           a.depth_units_per_metre == b.depth_units_per_metre && a.depth_min_m == b.depth_min_m &&
           a.depth_max_m == b.depth_max_m && a.noise == b.noise && a.depth_correction == b.depth_correction &&
           a.body_from_camera.has_value() == b.body_from_camera.has_value() &&
           a.body_from_camera.value_or(Pose::Identity()).matrix() ==
               b.body_from_camera.value_or(Pose::Identity()).matrix();
}

}  // namespace planemap
