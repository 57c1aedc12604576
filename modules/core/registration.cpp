// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration.hpp"

#include <cmath>

namespace planemap {

DepthImage register_depth(const DepthImage& depth, const CameraInfo& camera) {
    if (camera.registered && camera.depth == camera.color) return depth;
    DepthImage registered(camera.color.width, camera.color.height);
    // With q = K_color R K_depth^-1 (u, v, 1) z + K_color t the pixel is (q.x / q.z, q.y / q.z); the first
    // term is linear in u along a row.
    const PinholeCamera &from = camera.depth, &to = camera.color;
    Eigen::Matrix3d k_color, k_depth_inverse;
    k_color << to.fx, 0, to.cx, 0, to.fy, to.cy, 0, 0, 1;
    k_depth_inverse << 1 / from.fx, 0, -from.cx / from.fx, 0, 1 / from.fy, -from.cy / from.fy, 0, 0, 1;
    const Pose color_from_depth = camera.registered ? Pose::Identity() : camera.color_from_depth;
    const Eigen::Matrix3f m = (k_color * color_from_depth.linear() * k_depth_inverse).cast<float>();
    const Eigen::Vector3f t =
        (k_color * color_from_depth.translation() * camera.depth_units_per_metre).cast<float>();  // raw units
    const auto width = static_cast<float>(to.width), height = static_cast<float>(to.height);
    for (int v = 0; v < depth.height; ++v) {
        const std::uint16_t* row = depth.row(v);
        const Eigen::Vector3f base = m.col(1) * static_cast<float>(v) + m.col(2);
        for (int u = 0; u < depth.width; ++u) {
            if (!is_valid_depth(row[u])) continue;
            const float z = row[u], column = static_cast<float>(u);
            const float qz = (base.z() + m(2, 0) * column) * z + t.z();
            if (!(qz >= 0.5f && qz < 65534.5f)) continue;
            const float inverse = 1.0f / qz;
            const float x = ((base.x() + m(0, 0) * column) * z + t.x()) * inverse + 0.5f;
            const float y = ((base.y() + m(1, 0) * column) * z + t.y()) * inverse + 0.5f;
            if (!(x >= 0 && y >= 0 && x < width && y < height)) continue;
            std::uint16_t& target = registered(static_cast<int>(x), static_cast<int>(y));
            const auto value = static_cast<std::uint16_t>(qz + 0.5f);
            if (target == 0 || value < target) target = value;
        }
    }
    return registered;
}

}  // namespace planemap
