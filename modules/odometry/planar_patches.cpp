// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/planar_patches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/rounding.hpp"

namespace planemap::odometry {
namespace {

constexpr double kSamePlaneAngle = 0.26;  // 15 degrees between a cell and the region it lies on
constexpr double kSamePlaneGap = 0.05;    // metres beside the region's outline

bool is_trusted(double z, const CameraInfo& info) {
    return z >= info.depth_min_m && z <= info.depth_max_m;
}

/// Sums of readings of a cell, pixels relative to the cell's centre.
struct CellSums {
    Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squared = 0;  ///< of inverse depth
    double z = 0;
};

/// Not segmentation's fit: over pixels of a small cell, each weighted alike, with its own bytes.
struct CellFit {
    Plane plane;
    double tilt = 0;  ///< radians, standard deviation about either axis
};

/// The plane of 1/z = a u + b v + c; d = 0 when the readings are not on one.
CellFit fit_cell(const CellSums& sums, double u0, double v0, const PinholeCamera& camera,
                 const CameraInfo& info) {
    const double n = sums.left(2, 2);
    const Eigen::Vector3d abc = sums.left.inverse() * sums.right;
    if (!abc.allFinite()) return {};
    const double variance = std::max(0.0, sums.squared - abc.dot(sums.right)) / n;
    const double z = sums.z / n, sigma = info.noise.sigma(z) / (z * z);
    if (std::sqrt(variance) > 2 * sigma) return {};
    const double c = abc.z() - abc.x() * u0 - abc.y() * v0;
    const Eigen::Vector3d normal(abc.x() * camera.fx, abc.y() * camera.fy,
                                 abc.x() * camera.cx + abc.y() * camera.cy + c);
    const double norm = normal.norm();
    if (!(norm > 1e-6)) return {};
    // A slope of 1/z is as uncertain as what readings scatter by allows, and tilts the plane by f d times
    // that.
    const double per_slope =
        0.5 * (sums.left(0, 0) + sums.left(1, 1)) -
        0.5 * (sums.left(0, 2) * sums.left(0, 2) + sums.left(1, 2) * sums.left(1, 2)) / n;
    const double tilt = camera.fx / norm * std::sqrt(variance * n / ((n - 3) * per_slope));
    return {{-normal / norm, 1 / norm}, tilt};
}

/// What a sample on the surface says.
struct Hit {
    double r = 0;  ///< distance, in sigmas
    double weight = 0;
    Twist j = Twist::Zero();  ///< of r, by the camera's small motion
    Eigen::Vector3d normal;   ///< of the surface, camera frame
    double sigma = 0;         ///< metres
    Eigen::Vector2d pixel;    ///< in the keyframe
};

/// Nothing beside the surface; `visible` counts those that fall on a cell of it.
std::optional<Hit> hit(const PlanarPatches& patches, const PinholeCamera& camera, const DepthSample& sample,
                       const Pose& camera_from_keyframe, const Pose& keyframe_from_camera, double gate_m,
                       double weight, int& visible) {
    Hit hit;
    const Eigen::Vector3d p = keyframe_from_camera * sample.point;
    if (!(p.z() > 0.05)) return std::nullopt;
    hit.pixel = camera.project(p);
    const Plane* plane = patches.at(hit.pixel);
    if (!plane) return std::nullopt;
    ++visible;
    const double distance = plane->signed_distance(p);
    hit.normal = camera_from_keyframe.linear() * plane->normal;
    // Depth noise moves the point along its ray; both views have it.
    const double slant = std::abs(hit.normal.dot(sample.point)) / sample.point.z();
    hit.sigma = 1.4 * sample.sigma * std::max(slant, 0.2);
    if (!(std::abs(distance) < std::max(gate_m, 3 * hit.sigma)) || slant < 0.1) return std::nullopt;
    hit.r = distance / hit.sigma;
    hit.j << -hit.normal / hit.sigma, hit.normal.cross(sample.point) / hit.sigma;
    hit.weight = weight / (1 + hit.r * hit.r / 4);
    return hit;
}

}  // namespace

std::vector<DepthSample> sample_depth(const DepthImage& depth, const PinholeCamera& camera,
                                      const CameraInfo& info, int stride_px) {
    std::vector<DepthSample> samples;
    for (int v = stride_px / 2; v < depth.height; v += stride_px) {
        const std::uint16_t* row = depth.row(v);
        for (int u = stride_px / 2; u < depth.width; u += stride_px) {
            const double z = info.metres(row[u]);
            if (!is_valid_depth(row[u]) || !is_trusted(z, info)) continue;
            samples.push_back({camera.unproject(u, v, z), info.noise.sigma(z), row_share(camera, v)});
        }
    }
    return samples;
}

std::vector<DepthSample> without_shutter(std::vector<DepthSample> samples, const Twist& over_readout) {
    if (over_readout.isZero(0)) return samples;
    for (DepthSample& sample : samples) sample.point = moved(-sample.row_share * over_readout, sample.point);
    return samples;
}

PlanarPatches::PlanarPatches(const DepthImage& depth, const PinholeCamera& camera, const CameraInfo& info,
                             int cell_px, const Twist& over_readout)
    : camera_(camera),
      cell_px_(cell_px),
      planes_(depth.width / cell_px, depth.height / cell_px),
      tilts_(planes_.width, planes_.height) {
    const int needed = cell_px * cell_px / 4 * 3 / 4;  // of every other pixel of every other row
    const double centre = 0.5 * cell_px;
    for (int row = 0; row < planes_.height; ++row) {
        for (int column = 0; column < planes_.width; ++column) {
            CellSums sums;
            for (int j = 0; j < cell_px; j += 2) {
                const std::uint16_t* readings =
                    depth.row(row * cell_px + j) + std::ptrdiff_t{column} * cell_px;
                for (int i = 0; i < cell_px; i += 2) {
                    const double z = info.metres(readings[i]);
                    if (!is_valid_depth(readings[i]) || !is_trusted(z, info)) continue;
                    const double w = 1 / z, u = i - centre, v = j - centre;
                    sums.left(0, 0) += u * u;
                    sums.left(0, 1) += u * v;
                    sums.left(1, 1) += v * v;
                    sums.left(0, 2) += u;
                    sums.left(1, 2) += v;
                    sums.left(2, 2) += 1;
                    sums.right += w * Eigen::Vector3d(u, v, 1);
                    sums.squared += w * w;
                    sums.z += z;
                }
            }
            if (sums.left(2, 2) < needed) continue;
            sums.left.triangularView<Eigen::StrictlyLower>() = sums.left.transpose();
            Plane& plane = planes_(column, row);
            const CellFit fit =
                fit_cell(sums, column * cell_px + centre, row * cell_px + centre, camera, info);
            plane = fit.plane;
            if (!(plane.d > 0)) continue;
            tilts_(column, row) = static_cast<float>(fit.tilt);
            ++count_;
            const double late = row_share(camera, row * cell_px + centre);
            plane = pose_from_twist(-late * over_readout) * plane;
        }
    }
}

void PlanarPatches::lay_on(std::span<const PlanarRegion> regions, const DepthNoise& noise) {
    const double centre = 0.5 * (cell_px_ - 1);
    for (int row = 0; row < planes_.height; ++row) {
        for (int column = 0; column < planes_.width; ++column) {
            Plane& plane = planes_(column, row);
            if (!(plane.d > 0)) continue;
            const Eigen::Vector3d ray =
                camera_.unproject(column * cell_px_ + centre, row * cell_px_ + centre, 1);
            const Eigen::Vector3d p = ray * (-plane.d / plane.normal.dot(ray));
            double nearest = noise.sigma(p.z());
            const PlanarRegion* on = nullptr;
            for (const PlanarRegion& region : regions) {
                const double off = std::abs(region.plane.signed_distance(p));
                if (off > nearest || angle_between(region.plane.normal, plane.normal) > kSamePlaneAngle ||
                    distance(region, region.plane.project(p)) > kSamePlaneGap)
                    continue;
                nearest = off;
                on = &region;
            }
            if (!on) continue;
            plane = on->plane;
            tilts_(column, row) = 0;
        }
    }
}

Eigen::Vector2i PlanarPatches::cell_of(const Eigen::Vector2d& pixel) const {
    if (!(pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < 1e5 && pixel.y() < 1e5)) return {-1, -1};
    return {nearest_whole<int>(pixel.x()) / cell_px_, nearest_whole<int>(pixel.y()) / cell_px_};
}

const Plane* PlanarPatches::at(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2i cell = cell_of(pixel);
    if (!planes_.contains(cell.x(), cell.y())) return nullptr;
    const Plane& plane = planes_(cell.x(), cell.y());
    return plane.d > 0 ? &plane : nullptr;
}

double PlanarPatches::tilt(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2i cell = cell_of(pixel);
    return static_cast<double>(tilts_(cell.x(), cell.y()));
}

PatchMatch match_patches(const PlanarPatches& patches, const PinholeCamera& camera,
                         const std::vector<DepthSample>& samples, const Pose& camera_from_keyframe,
                         double gate_m, double weight) {
    PatchMatch match;
    match.term.at = camera_from_keyframe;
    std::array<QuadraticTerm, kTiles> tiles;
    const Pose keyframe_from_camera = camera_from_keyframe.inverse();
    double squared = 0;
    for (const DepthSample& sample : samples) {
        const std::optional<Hit> found = hit(patches, camera, sample, camera_from_keyframe,
                                             keyframe_from_camera, gate_m, weight, match.visible);
        if (!found) continue;
        const Eigen::Vector2d pixel = camera.project(sample.point);
        QuadraticTerm& tile = tiles[static_cast<std::size_t>(tile_of(camera, pixel.x(), pixel.y()))];
        const Twist weighted = found->weight * found->j;
        tile.information += found->j * weighted.transpose();
        tile.gradient += (found->weight * found->r) * found->j;
        squared += found->r * found->r;
        ++match.matched;
    }
    for (QuadraticTerm& tile : tiles) {
        if (tile.information.trace() == 0) continue;
        tile.at = camera_from_keyframe;
        tile.information.triangularView<Eigen::StrictlyLower>() = tile.information.transpose();
        match.term.information += tile.information;
        match.term.gradient += tile.gradient;
        match.tiles.push_back(tile);
    }
    if (match.matched > 0) match.residual = std::sqrt(squared / match.matched);
    return match;
}

Matrix6d information_of_tilts(const PlanarPatches& patches, const PinholeCamera& camera,
                              const std::vector<DepthSample>& samples, const Pose& camera_from_keyframe,
                              double gate_m, double weight) {
    Matrix6d information = Matrix6d::Zero();
    const Pose keyframe_from_camera = camera_from_keyframe.inverse();
    int visible = 0;
    for (const DepthSample& sample : samples) {
        const std::optional<Hit> found =
            hit(patches, camera, sample, camera_from_keyframe, keyframe_from_camera, gate_m, weight, visible);
        if (!found) continue;
        const double tilt = patches.tilt(found->pixel);
        if (tilt == 0) continue;
        const Eigen::Vector3d across = found->normal.unitOrthogonal();
        for (const Eigen::Vector3d& tilted : {across, Eigen::Vector3d(found->normal.cross(across))}) {
            Twist j;
            j << -tilted / found->sigma, tilted.cross(sample.point) / found->sigma;
            information += found->weight * tilt * tilt * j * j.transpose();
        }
    }
    return information;
}

}  // namespace planemap::odometry
