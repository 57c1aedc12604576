// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/validation.hpp"

namespace planemap {

/// A pinhole camera. Optical frame: x right, y down, z forward; pixel centres at integers.
struct PinholeCamera {
    int width = 0, height = 0;  ///< pixels
    double fx = 0, fy = 0;      ///< focal lengths, pixels
    double cx = 0, cy = 0;      ///< principal point, pixels

    /// Point at depth z (metres along the optical axis) seen at pixel (u, v).
    Eigen::Vector3d unproject(double u, double v, double z) const {
        return {(u - cx) * z / fx, (v - cy) * z / fy, z};
    }
    /// Pixel of a point with z > 0.
    Eigen::Vector2d project(const Eigen::Vector3d& p) const {
        return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
    }
    /// True when the pixel (u, v) falls on the image.
    bool sees(const Eigen::Vector2d& pixel) const {
        return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < width - 0.5 && pixel.y() < height - 0.5;
    }
    friend bool operator==(const PinholeCamera&, const PinholeCamera&) = default;
};

/// What the numbers of a real camera are within, from a fish's eye to a telescope. Beyond, one was mistyped
/// or is of another image.
struct CameraLimits {
    static constexpr double kLeastFocal = 0.2, kMostFocal = 10;   ///< of the image's longer side
    static constexpr double kLeastAspect = 0.5, kMostAspect = 2;  ///< fx / fy
    static constexpr double kOutside = 0.5;  ///< principal point: so many of its sides out of the image
    static constexpr double kLeastUnits = 100, kMostUnits = 1e5;  ///< of depth a metre: 1 cm to 0.01 mm
    static constexpr double kLeastSigma_m = 1e-6;  ///< of depth's noise; without any, no reading
                                                   ///< would agree with another
};

/// Share of the range by which depth is taken to be bent, where nobody says how.
inline constexpr double kRangeBias = 0.01;

/// Noise of the depth sensor: standard deviation of depth at z metres, base + quadratic (z - offset)^2,
/// metres. The default is the Kinect's (Nguyen et al. 2012).
struct DepthNoise {
    double base_m = 0.0012;
    double quadratic_per_m = 0.0019;
    double offset_m = 0.4;

    double sigma(double z) const { return base_m + quadratic_per_m * (z - offset_m) * (z - offset_m); }
    friend bool operator==(const DepthNoise&, const DepthNoise&) = default;
};

/// What the readings of a sensor are off by, smoothly over the image: true inverse depth is the sensed one
/// plus an offset, so that the error of depth grows with the square of the range (Teichman, Miller and Thrun,
/// RSS 2013, found it so for the Kinect and the Xtion). Offsets at kColumns x kRows nodes, row by row from
/// the depth image's upper left corner to its lower right one, bilinear between them; see
/// depth_correction.hpp.
struct DepthCorrection {
    static constexpr std::size_t kColumns = 5, kRows = 4, kNodes = kColumns * kRows;
    static constexpr double kMost_per_m = 0.1;  ///< of an offset: 40 cm at 2 m

    std::array<double, kNodes> offsets{};  ///< 1/metres
    std::array<double, kNodes> sigmas{};   ///< their standard deviations where they are known, else 0

    friend bool operator==(const DepthCorrection&, const DepthCorrection&) = default;
};

/// How a lens moves what a pinhole would draw, in OpenCV's models and the order of its coefficients, on
/// ((u - cx) / fx, (v - cy) / fy); see lens_distortion.hpp.
struct LensDistortion {
    enum class Model {
        kBrown,    ///< radial and tangential: k1 k2 p1 p2, then k3, then k4 k5 k6 (ROS: plumb_bob and
                   ///< rational_polynomial)
        kFisheye,  ///< by the angle to the axis: k1 k2 k3 k4 (ROS: equidistant)
    };
    Model model = Model::kBrown;
    std::vector<double> coefficients;  ///< brown: 4, 5 or 8; fisheye: 4

    friend bool operator==(const LensDistortion&, const LensDistortion&) = default;
};

/// Adds each field that no sensor's depth has, named as in CameraInfo: a range that is not finite, negative
/// or empty; noise that is not finite, negative, below CameraLimits::kLeastSigma_m everywhere in the range,
/// or beyond it.
void check_depth(const DepthNoise& noise, double min_m, double max_m, FieldErrors& errors);

/// What an RGB-D sensor is: the project's "camera frame" is the optical frame of `color`. A sensor without
/// colour has color equal to depth.
struct CameraInfo {
    std::string serial;   ///< or a name that tells sensors apart; at most 64 characters
    PinholeCamera depth;  ///< of the depth image as it arrives
    PinholeCamera color;  ///< of the colour image as it arrives
    /// Of the images as they arrive; none: they are a pinhole's. They are undone where images are decoded
    /// (see Undistortion), once: what comes after sees pinholes.
    std::optional<LensDistortion> depth_distortion, color_distortion;
    bool registered = true;                       ///< each depth pixel already lies at its colour pixel,
                                                  ///< once both are undistorted
    Pose color_from_depth = Pose::Identity();     ///< identity when registered
    double depth_units_per_metre = 1000;          ///< raw depth / this = metres
    double depth_min_m = 0.3, depth_max_m = 8.0;  ///< readings outside are not trusted
    DepthNoise noise;
    std::optional<DepthCorrection> depth_correction;  ///< of its readings as they arrive; none: as they are
    /// How the camera is mounted on a robot whose body frame is x forward, y left, z up; none: it was not
    /// told.
    std::optional<Pose> body_from_camera;

    double metres(std::uint16_t raw) const { return raw / depth_units_per_metre; }
    /// Throws std::invalid_argument that names every bad field (sizes 1 to 8192, what CameraLimits says, the
    /// depth camera's focal lengths 0.3 to 4 times the colour camera's, a depth range that 16 bits reach,
    /// what check_distortion() says, ...).
    void validate() const;
};

bool operator==(const CameraInfo& a, const CameraInfo& b);

}  // namespace planemap
