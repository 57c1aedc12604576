// SPDX-License-Identifier: BSD-3-Clause
// A keyframe's depth as small planes, and other frames' depth held against it (point to plane).
#pragma once

#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/plane.hpp"
#include "core/image.hpp"
#include "core/region.hpp"
#include "odometry/alignment.hpp"

namespace planemap::odometry {

/// One reading of a depth image.
struct DepthSample {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< camera frame, metres
    double sigma = 0;                                 ///< of its depth, metres
    double row_share = 0;                             ///< see row_share()
};

/// Every stride-th valid reading, rows and columns. `camera` is the camera the depth image is registered to.
std::vector<DepthSample> sample_depth(const DepthImage& depth, const PinholeCamera& camera,
                                      const CameraInfo& info, int stride_px);

/// The samples where they were at the image's time; the camera moves by `over_readout` while it is read out.
std::vector<DepthSample> without_shutter(std::vector<DepthSample> samples, const Twist& over_readout);

/// The surface seen in a depth image: one plane for each square cell whose readings lie on one.
/// A plane is linear in inverse depth, 1/z = a u + b v + c, so a cell is a 3x3 least-squares fit.
/// Segmentation fits cells, too, but for another end, all pixels weighted by z^2 in single precision, eight
/// cells at a time; here every fourth pixel counts alike, in double precision.
class PlanarPatches {
  public:
    PlanarPatches() = default;
    /// The camera moves by `over_readout` while the image is read out; the planes are those of its time.
    PlanarPatches(const DepthImage& depth, const PinholeCamera& camera, const CameraInfo& info, int cell_px,
                  const Twist& over_readout = Twist::Zero());

    /// Lays cells that lie on a region, within the noise of a reading, onto its plane. A cell's own plane
    /// tilts by its noise, and a wall of tilted cells holds a camera that slides along it.
    void lay_on(std::span<const PlanarRegion> regions, const DepthNoise& noise);

    /// Number of cells with a plane.
    int cells() const { return count_; }
    /// The plane at a pixel (camera frame), or nullptr.
    const Plane* at(const Eigen::Vector2d& pixel) const;
    /// By how much noise tilts the plane at a pixel, radians about either axis, by what its readings scatter;
    /// 0 where it is a region's. Precondition: there is one.
    double tilt(const Eigen::Vector2d& pixel) const;

  private:
    /// The cell of a pixel, (-1, -1) outside.
    Eigen::Vector2i cell_of(const Eigen::Vector2d& pixel) const;

    PinholeCamera camera_;
    int cell_px_ = 1, count_ = 0;
    Image<Plane> planes_;  ///< of the cells; d = 0: none
    Image<float> tilts_;
};

struct PatchMatch {
    QuadraticTerm term;  ///< about the pose it was asked for
    std::vector<QuadraticTerm>
        tiles;            ///< the same by the samples' tiles (see tile_of()), empty ones left out
    int matched = 0;      ///< samples on the surface
    int visible = 0;      ///< samples that fall on a cell of the surface, matched or not
    double residual = 0;  ///< RMS distance of the matched samples, in sigmas
};

/// Distances of a frame's samples to a keyframe's surface at camera_from_keyframe, weighted by the depth
/// noise and a heavy tail; samples further off than the larger of gate_m and 3 sigma are left out. `weight`
/// scales the information of each sample, whose errors are not independent of its neighbours'.
PatchMatch match_patches(const PlanarPatches& patches, const PinholeCamera& camera,
                         const std::vector<DepthSample>& samples, const Pose& camera_from_keyframe,
                         double gate_m, double weight);

/// What of the information of match_patches(), with the same arguments, is owed to the tilts of cells that
/// are noise: a bare wall of tilted cells seems to hold a camera that slides along it. To be expected, so it
/// may be more than there is in a direction.
Matrix6d information_of_tilts(const PlanarPatches& patches, const PinholeCamera& camera,
                              const std::vector<DepthSample>& samples, const Pose& camera_from_keyframe,
                              double gate_m, double weight);

}  // namespace planemap::odometry
