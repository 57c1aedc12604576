// SPDX-License-Identifier: BSD-3-Clause
// A plane in inverse depth: with the normalised image coordinates x = (u - cx) / fx, y = (v - cy) / fy, the
// plane n.p + d = 0 is 1/z = a x + b y + c, linear in what a structured-light sensor measures. It is fitted
// to sums of points up to second order, the same that a region's moments are made of.
#pragma once

#include <cmath>

#include "core/geometry/moments.hpp"
#include "core/geometry/plane.hpp"

namespace planemap::segmentation {

/// 1/z = a x + b y + c, per metre.
struct InverseDepthPlane {
    double a = 0, b = 0, c = 0;

    double at(double x, double y) const { return a * x + b * y + c; }
    /// 1 / distance of the plane to the sensor.
    double steepness() const { return std::sqrt(a * a + b * b + c * c); }
    /// The plane with its normal towards the sensor. Precondition: steepness() > 0.
    Plane plane() const {
        const double s = steepness();
        return {Eigen::Vector3d(-a / s, -b / s, -c / s), 1 / s};
    }
    /// Cosine of the angle between two planes' normals.
    double cosine(const InverseDepthPlane& o) const {
        return (a * o.a + b * o.b + c * o.c) / (steepness() * o.steepness());
    }
};

/// A fit to points (x, y, w = 1/z), each weighted by z^2, with the points' second central moments.
struct InverseDepthFit {
    InverseDepthPlane plane;
    double x = 0, y = 0, w = 0;     ///< weighted mean
    double xx = 0, xy = 0, yy = 0;  ///< covariance of the image coordinates
    double mse = 0;                 ///< mean squared residual of w
    bool valid = false;             ///< false when the points do not determine a plane

    /// Mean squared residual of the same points to another plane.
    double mse_to(const InverseDepthPlane& o) const {
        const double da = plane.a - o.a, db = plane.b - o.b, offset = w - o.at(x, y);
        return mse + offset * offset + da * da * xx + 2 * da * db * xy + db * db * yy;
    }
};

/// Weighted sums of points (X, Y, Z) in metres, camera frame. Plain data, as the kernels write it.
struct PointSums {
    double n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    PointSums& operator+=(const PointSums& o) { return add(1, o); }
    /// Adds k times the sums.
    PointSums& add(double k, const PointSums& o) {
        n += k * o.n, x += k * o.x, y += k * o.y, z += k * o.z, xx += k * o.xx;
        xy += k * o.xy, xz += k * o.xz, yy += k * o.yy, yz += k * o.yz, zz += k * o.zz;
        return *this;
    }
    Moments moments() const;
    /// The plane that minimises the sum of (1 - z (a x + b y + c))^2: least squares of inverse depth,
    /// weighted by z^2, whose regressors, the image coordinates, are free of noise. In closed form.
    InverseDepthFit fit() const;
};

}  // namespace planemap::segmentation
