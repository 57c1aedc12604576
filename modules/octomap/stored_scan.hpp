// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/octomap_types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/pose.hpp"
#include "core/image.hpp"

namespace planemap::octomap {

/// A depth image with its camera, compressed without loss: about 150 KB at 640 x 480.
class StoredScan {
  public:
    /// depth as it came from the depth camera, not registered. Throws std::invalid_argument for an invalid
    /// camera or an image whose size is not camera.depth's.
    StoredScan(const DepthImage& depth, const CameraInfo& camera);

    const CameraInfo& camera() const { return camera_; }
    std::size_t bytes() const { return sizeof *this + deflated_.capacity(); }
    /// Where the readings lie in the world, metres, of every n-th pixel along u and v. Readings outside the
    /// camera's depth range are left out.
    std::vector<::octomap::point3d> points(const Pose& world_from_camera, int subsample) const;
    /// Where the depth camera is in the world, metres.
    ::octomap::point3d origin(const Pose& world_from_camera) const;

  private:
    CameraInfo camera_;
    std::string deflated_;
};

}  // namespace planemap::octomap
