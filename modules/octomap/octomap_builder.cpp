// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_builder.hpp"

#include <libdeflate.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/validation.hpp"

namespace planemap {

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
    if (result != LIBDEFLATE_SUCCESS) throw std::logic_error("OctomapBuilder: stored depth does not inflate");
    for (int v = 0; v < height; ++v) {
        std::uint16_t* row = depth.row(v);
        for (int u = 1; u < width; ++u) row[u] = static_cast<std::uint16_t>(row[u] + row[u - 1]);
    }
    return depth;
}

octomap::point3d point3d(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

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

OctomapBuilder::OctomapBuilder(OctomapOptions options) : options_(options) {
    options_.validate();
    tree_ = std::make_unique<octomap::OcTree>(options_.resolution_m);
}

bool OctomapBuilder::add(int keyframe_id, const DepthImage& depth, const CameraInfo& camera,
                         const Pose& world_from_camera) {
    camera.validate();
    if (depth.width != camera.depth.width || depth.height != camera.depth.height ||
        !is_valid(world_from_camera)) {
        return false;
    }
    const bool in_order = keyframes_.empty() || keyframes_.rbegin()->first < keyframe_id;
    const Stored& stored = keyframes_[keyframe_id] = {camera, deflated(depth), world_from_camera};
    if (in_order && !rebuild_due_) {
        insert(*tree_, stored);
    } else {
        rebuild_due_ = true;
    }
    stale_ = true;
    if (keyframes_.size() > options_.max_keyframes) freeze_oldest();
    return true;
}

bool OctomapBuilder::update(const KeyframeTrajectory& trajectory) {
    for (const KeyframePose& named : trajectory.keyframes) {
        const auto found = keyframes_.find(named.id);
        if (found == keyframes_.end() || !is_valid(named.world_from_camera)) continue;
        Pose& world_from_camera = found->second.world_from_camera;
        const Pose change = world_from_camera.inverse(Eigen::Isometry) * named.world_from_camera;
        if (change.translation().norm() <= options_.moved_m &&
            rotation_angle(change) <= options_.moved_deg * std::numbers::pi / 180) {
            continue;
        }
        world_from_camera = named.world_from_camera;
        rebuild_due_ = true;
    }
    return rebuild_due_;
}

void OctomapBuilder::flush() {
    if (rebuild_due_) {
        tree_ = base_ ? std::make_unique<octomap::OcTree>(*base_)
                      : std::make_unique<octomap::OcTree>(options_.resolution_m);
        for (const auto& [id, stored] : keyframes_) insert(*tree_, stored);
        rebuild_due_ = false;
        stale_ = true;
        ++rebuilds_;
    }
    if (!stale_) return;
    tree_->updateInnerOccupancy();
    tree_->prune();
    stale_ = false;
}

std::vector<octomap::point3d> OctomapBuilder::points_in_world(const Stored& stored) const {
    const CameraInfo& camera = stored.camera;
    const PinholeCamera& pinhole = camera.depth;
    const DepthImage depth = inflated(stored.deflated, pinhole.width, pinhole.height);
    const Pose world_from_depth = stored.world_from_camera * camera.color_from_depth;
    std::vector<octomap::point3d> points;
    points.reserve(depth.pixels.size() / static_cast<std::size_t>(options_.subsample * options_.subsample));
    for (int v = 0; v < depth.height; v += options_.subsample) {
        for (int u = 0; u < depth.width; u += options_.subsample) {
            const std::uint16_t raw = depth(u, v);
            const double z = camera.metres(raw);
            if (!is_valid_depth(raw) || z < camera.depth_min_m || z > camera.depth_max_m) continue;
            points.push_back(point3d(world_from_depth * pinhole.unproject(u, v, z)));
        }
    }
    return points;
}

void OctomapBuilder::insert(octomap::OcTree& tree, const Stored& stored) {
    const Pose world_from_depth = stored.world_from_camera * stored.camera.color_from_depth;
    const double max_range = options_.max_range_m > 0 ? options_.max_range_m : stored.camera.depth_max_m;
    inserter_.insert(tree, points_in_world(stored), point3d(world_from_depth.translation()), max_range);
}

void OctomapBuilder::freeze_oldest() {
    const auto oldest = keyframes_.begin();
    if (!base_) base_ = std::make_unique<octomap::OcTree>(options_.resolution_m);
    insert(*base_, oldest->second);
    keyframes_.erase(oldest);
    ++frozen_;
}

std::vector<Eigen::Vector3d> OctomapBuilder::occupied_voxels() const {
    std::vector<Eigen::Vector3d> centres;
    const double edge = options_.resolution_m;
    for (auto leaf = tree_->begin_leafs(), end = tree_->end_leafs(); leaf != end; ++leaf) {
        if (!tree_->isNodeOccupied(*leaf)) continue;
        const int n = 1 << (tree_->getTreeDepth() - leaf.getDepth());
        const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
        const Eigen::Vector3d first = centre - Eigen::Vector3d::Constant(0.5 * edge * (n - 1));
        for (int i = 0; i < n * n * n; ++i)
            centres.push_back(first + edge * Eigen::Vector3d(i % n, i / n % n, i / (n * n)));
    }
    return centres;
}

std::size_t OctomapBuilder::voxel_cloud_size(double voxel_m) const {
    VoxelSet voxels;
    for (const auto& [id, stored] : keyframes_) {
        for (const octomap::point3d& p : points_in_world(stored)) {
            const Eigen::Array3d cell = (Eigen::Array3d(p.x(), p.y(), p.z()) / voxel_m).floor();
            if (!((cell.abs() < VoxelSet::kMaxCoordinate).all())) continue;
            voxels.insert(
                {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
        }
    }
    return voxels.size();
}

std::size_t OctomapBuilder::stored_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, stored] : keyframes_) bytes += sizeof stored + stored.deflated.capacity();
    return bytes;
}

std::size_t OctomapBuilder::working_bytes() const {
    return tree_->memoryUsage() + (base_ ? base_->memoryUsage() : 0) + stored_bytes() +
           inserter_.memory_bytes();
}

}  // namespace planemap
