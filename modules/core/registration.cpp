// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration.hpp"

#include <cmath>
#include <vector>

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
    const float mx = m(0, 0), my = m(1, 0), mz = m(2, 0), tx = t.x(), ty = t.y(), tz = t.z();
    const auto width = static_cast<float>(to.width), height = static_cast<float>(to.height);
    const int to_width = to.width;
    std::uint16_t* const pixels = registered.pixels.data();
    const auto columns = static_cast<std::size_t>(depth.width);
    std::vector<float> x(columns), y(columns), z(columns);
    for (int v = 0; v < depth.height; ++v) {
        const std::uint16_t* row = depth.row(v);
        const Eigen::Vector3f base = m.col(1) * static_cast<float>(v) + m.col(2);
        const float base_x = base.x(), base_y = base.y(), base_z = base.z();
        // Without a branch, for the compiler to take several pixels at a time.
        for (int u = 0; u < depth.width; ++u) {
            const float raw = static_cast<float>(row[u]), column = static_cast<float>(u);
            const float qz = (base_z + mz * column) * raw + tz;
            const float inverse = 1.0f / qz;  // infinite, and no pixel, for qz = 0
            x[u] = ((base_x + mx * column) * raw + tx) * inverse + 0.5f;
            y[u] = ((base_y + my * column) * raw + ty) * inverse + 0.5f;
            z[u] = qz;
        }
        for (int u = 0; u < depth.width; ++u) {
            if (!is_valid_depth(row[u]) || !(z[u] >= 0.5f && z[u] < 65534.5f) ||
                !(x[u] >= 0 && y[u] >= 0 && x[u] < width && y[u] < height))
                continue;
            std::uint16_t& target = pixels[static_cast<int>(y[u]) * to_width + static_cast<int>(x[u])];
            const auto value = static_cast<std::uint16_t>(z[u] + 0.5f);
            // A reading of 0, none, wraps to the farthest of all.
            if (static_cast<std::uint16_t>(target - 1) >= value) target = value;
        }
    }
    return registered;
}

}  // namespace planemap
