// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/inverse_depth.hpp"

#include <algorithm>

namespace planemap {

InverseDepthFit InverseDepthSums::fit() const {
    InverseDepthFit fit;
    if (!(n > 0)) return fit;
    const double k = 1 / n;
    fit.x = x * k, fit.y = y * k, fit.w = w * k;
    fit.xx = xx * k - fit.x * fit.x;
    fit.xy = xy * k - fit.x * fit.y;
    fit.yy = yy * k - fit.y * fit.y;
    const double xw_c = xw * k - fit.x * fit.w, yw_c = yw * k - fit.y * fit.w, ww_c = ww * k - fit.w * fit.w;
    const double determinant = fit.xx * fit.yy - fit.xy * fit.xy;
    if (!(determinant > 1e-6 * fit.xx * fit.yy) || !(determinant > 1e-18)) return fit;
    fit.plane.a = (fit.yy * xw_c - fit.xy * yw_c) / determinant;
    fit.plane.b = (fit.xx * yw_c - fit.xy * xw_c) / determinant;
    fit.plane.c = fit.w - fit.plane.a * fit.x - fit.plane.b * fit.y;
    fit.mse = std::max(0.0, ww_c - fit.plane.a * xw_c - fit.plane.b * yw_c);
    fit.valid = fit.plane.steepness() > 0;
    return fit;
}

}  // namespace planemap
