// SPDX-License-Identifier: BSD-3-Clause
// A keyframe's region as evidence of a plane of the world, and how much it counts.
#pragma once

#include "core/camera.hpp"
#include "map/plane_estimate.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// A region where the pose of its keyframe puts it. It refers to both: they must outlive it.
struct Observation {
    const StoredKeyframe& keyframe;
    const StoredRegion& region;
    PlacedRegion placed;

    /// Precondition: the keyframe has a pose.
    Observation(const StoredKeyframe& seen_by, const StoredRegion& seen)
        : keyframe(seen_by), region(seen), placed(*seen_by.world_from_camera, seen) {}

    Pose world_from_box() const { return placed.box.frame_from_box; }
    /// Near enough to the world's origin to be mapped, see kMaxCoordinate_m.
    bool is_near() const { return is_near_origin(placed.box.frame_from_box.translation()); }
};

/// What an observation counts for, by the noise at its depth of the sensor that saw it and the error of
/// poses.
struct ObservationModel {
    double pose_sigma_m;  ///< below it, less sensor noise gains no weight
    double agreement_m;   ///< an observation off its plane by much more (and the noise) loses weight

    /// Inverse variance of a region about its plane, relative to a noise-free sensor: 0 to 1.
    double weight(const StoredRegion& region_camera, const DepthNoise& noise) const;
    Reliability reliability(const StoredRegion& region_camera, const DepthNoise& noise) const;
    /// 2^strength is the support that it gives the shape, see EvidenceCells: 2 for a near one, 0 for a far
    /// one.
    int strength(const StoredRegion& region_camera, const DepthNoise& noise) const;
};

}  // namespace planemap::map
