// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/point_sums.hpp"

#include <algorithm>

namespace planemap::segmentation {

Moments PointSums::moments() const {
    Moments m;
    m.count = n;
    m.sum << x, y, z;
    m.scatter << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
}

InverseDepthFit PointSums::fit() const {
    // With weights z^2 the sums of 1, x, y, ... over the image coordinates are those of Z^2, XZ, YZ, ...
    InverseDepthFit fit;
    if (!(zz > 0)) return fit;
    const double k = 1 / zz;
    fit.x = xz * k, fit.y = yz * k, fit.w = z * k;
    fit.xx = xx * k - fit.x * fit.x;
    fit.xy = xy * k - fit.x * fit.y;
    fit.yy = yy * k - fit.y * fit.y;
    const double xw = x * k - fit.x * fit.w, yw = y * k - fit.y * fit.w, ww = n * k - fit.w * fit.w;
    const double determinant = fit.xx * fit.yy - fit.xy * fit.xy;
    if (!(determinant > 1e-6 * fit.xx * fit.yy) || !(determinant > 1e-18)) return fit;
    fit.plane.a = (fit.yy * xw - fit.xy * yw) / determinant;
    fit.plane.b = (fit.xx * yw - fit.xy * xw) / determinant;
    fit.plane.c = fit.w - fit.plane.a * fit.x - fit.plane.b * fit.y;
    fit.mse = std::max(0.0, ww - fit.plane.a * xw - fit.plane.b * yw);
    fit.valid = fit.plane.steepness() > 0;
    return fit;
}

}  // namespace planemap::segmentation
