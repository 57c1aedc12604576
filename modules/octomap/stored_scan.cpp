// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/stored_scan.hpp"

#include <libdeflate.h>

#include <memory>
#include <stdexcept>

namespace planemap::octomap {

namespace {

using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;

/// The pixels as a deflate stream, each row as differences from pixel to pixel: half the size, and as fast.
std::string deflated(const DepthImage& depth) {
    DepthImage steps = depth;
    for (int v = 0; v < steps.height; ++v) {
        std::uint16_t* row = steps.row(v);
        for (int u = steps.width - 1; u > 0; --u) row[u] = static_cast<std::uint16_t>(row[u] - row[u - 1]);
    }
    const Compressor compressor(libdeflate_alloc_compressor(1), libdeflate_free_compressor);
    const std::size_t size = steps.pixels.size() * sizeof(std::uint16_t);
    std::string bytes(libdeflate_deflate_compress_bound(compressor.get(), size), '\0');
    bytes.resize(
        libdeflate_deflate_compress(compressor.get(), steps.pixels.data(), size, bytes.data(), bytes.size()));
    bytes.shrink_to_fit();
    return bytes;
}

DepthImage inflated(const std::string& bytes, int width, int height) {
    DepthImage depth(width, height);
    const Decompressor decompressor(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    const auto result =
        libdeflate_deflate_decompress(decompressor.get(), bytes.data(), bytes.size(), depth.pixels.data(),
                                      depth.pixels.size() * sizeof(std::uint16_t), nullptr);
    if (result != LIBDEFLATE_SUCCESS) throw std::logic_error("StoredScan: stored depth does not inflate");
    for (int v = 0; v < height; ++v) {
        std::uint16_t* row = depth.row(v);
        for (int u = 1; u < width; ++u) row[u] = static_cast<std::uint16_t>(row[u] + row[u - 1]);
    }
    return depth;
}

::octomap::point3d octomap_point(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

StoredScan::StoredScan(const DepthImage& depth, const CameraInfo& camera) : camera_(camera) {
    camera.validate();
    if (depth.width != camera.depth.width || depth.height != camera.depth.height)
        throw std::invalid_argument("StoredScan: the depth image is not of the depth camera's size");
    deflated_ = deflated(depth);
}

std::vector<::octomap::point3d> StoredScan::points(const Pose& world_from_camera, int subsample) const {
    const PinholeCamera& pinhole = camera_.depth;
    const DepthImage depth = inflated(deflated_, pinhole.width, pinhole.height);
    const Pose world_from_depth = world_from_camera * camera_.color_from_depth;
    std::vector<::octomap::point3d> points;
    const auto step = static_cast<std::size_t>(subsample);
    points.reserve(depth.pixels.size() / (step * step));
    for (int v = 0; v < depth.height; v += subsample) {
        for (int u = 0; u < depth.width; u += subsample) {
            const std::uint16_t raw = depth(u, v);
            const double z = camera_.metres(raw);
            if (!is_valid_depth(raw) || z < camera_.depth_min_m || z > camera_.depth_max_m) continue;
            points.push_back(octomap_point(world_from_depth * pinhole.unproject(u, v, z)));
        }
    }
    return points;
}

::octomap::point3d StoredScan::origin(const Pose& world_from_camera) const {
    return octomap_point((world_from_camera * camera_.color_from_depth).translation());
}

}  // namespace planemap::octomap
