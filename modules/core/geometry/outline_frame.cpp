// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline_frame.hpp"

namespace planemap {

Outline projected(const Pose& b_from_a, Outline outline) {
    for (Ring& ring : outline.rings)
        for (Eigen::Vector2d& v : ring) v = (b_from_a * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>();
    return outline;
}

Eigen::AlignedBox2d bounds(const Outline& outline) {
    Eigen::AlignedBox2d box;
    for (const Ring& ring : outline.rings)
        for (const Eigen::Vector2d& v : ring) box.extend(v);
    return box;
}

Eigen::AlignedBox2d bounds(const FlatPolygon& polygon) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& v : polygon.vertices) box.extend(v);
    return box;
}

}  // namespace planemap
