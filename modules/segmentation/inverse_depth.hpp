// SPDX-License-Identifier: BSD-3-Clause
// A plane in inverse depth: with the normalised image coordinates x = (u - cx) / fx, y = (v - cy) / fy, the
// plane n.p + d = 0 is 1/z = a x + b y + c, linear in what a structured-light sensor measures.
#pragma once

#include <cmath>

#include "core/plane.hpp"

namespace planemap {

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

/// A fit to weighted points (x, y, w = 1/z), with the points' second central moments.
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

/// Weighted sums of points (x, y, w = 1/z); they add up over cells and regions.
struct InverseDepthSums {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, w = 0, xw = 0, yw = 0, ww = 0;

    InverseDepthSums& operator+=(const InverseDepthSums& o) {
        n += o.n, x += o.x, y += o.y, xx += o.xx, xy += o.xy, yy += o.yy;
        w += o.w, xw += o.xw, yw += o.yw, ww += o.ww;
        return *this;
    }
    friend InverseDepthSums operator*(double k, const InverseDepthSums& s) {
        return {k * s.n,  k * s.x, k * s.y,  k * s.xx, k * s.xy,
                k * s.yy, k * s.w, k * s.xw, k * s.yw, k * s.ww};
    }
    /// Weighted least squares in closed form.
    InverseDepthFit fit() const;
};

}  // namespace planemap
