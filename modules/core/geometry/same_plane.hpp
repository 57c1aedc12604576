// SPDX-License-Identifier: BSD-3-Clause
// When two planar regions are one plane of the world: the thresholds of paper section 2.3, for all that merge
// planes or ask what would be merged.
#pragma once

namespace planemap {

inline constexpr double kSamePlane_deg = 10;          ///< between the normals, at most
inline constexpr double kSamePlaneDistance_m = 0.05;  ///< between the planes, where the regions are
inline constexpr double kSamePlaneGap_m = 0.5;        ///< between the regions, within the plane

}  // namespace planemap
