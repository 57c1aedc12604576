// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_options.hpp"

#include "core/validation.hpp"

namespace planemap {

void OctomapOptions::validate() const {
    FieldErrors errors("OctomapOptions");
    errors.require(resolution_m >= 0.001 && resolution_m <= 10, "resolution_m", resolution_m, "0.001 to 10");
    errors.require(max_range_m >= 0 && max_range_m <= 1000, "max_range_m", max_range_m, "0 to 1000");
    errors.require(subsample >= 1 && subsample <= 64, "subsample", subsample, "1 to 64");
    errors.require(max_keyframes >= 1, "max_keyframes", static_cast<double>(max_keyframes), "at least 1");
    errors.require(moved_m >= 0 && moved_m <= 10, "moved_m", moved_m, "0 to 10");
    errors.require(moved_deg >= 0 && moved_deg <= 180, "moved_deg", moved_deg, "0 to 180");
    errors.throw_if_any();
}

}  // namespace planemap
