// SPDX-License-Identifier: BSD-3-Clause
// A keyframe's regions as they are kept, so that the map can be rebuilt when the keyframe moves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/keyframe.hpp"
#include "core/sight.hpp"
#include "map/evidence_grid.hpp"

namespace planemap::map {

/// Further from the world's origin, doubles no longer hold second moments to a millimetre.
constexpr double kMaxCoordinate_m = 1e5;
inline bool is_near_origin(const Eigen::Vector3d& p_world) {
    return p_world.norm() <= kMaxCoordinate_m;  // not NaN
}
/// Whether what a camera saw from there can be in a map.
inline bool is_placeable(const Pose& world_from_camera) {
    return is_valid(world_from_camera) && is_near_origin(world_from_camera.translation());
}

/// A planar region in 112 bytes and 4 a vertex of its outline, camera frame. Single precision about the
/// region's own centre and axes: a micrometre at ten metres.
struct StoredRegion {
    using Rotation = Eigen::Quaternion<float, Eigen::DontAlign>;

    float count = 0;                                         ///< N
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();          ///< of the points
    std::array<float, 6> covariance{};                       ///< in the box's axes: xx, yy, zz, xy, xz, yz
    Rotation camera_from_box = Rotation::Identity();         ///< z: the plane's normal, towards the camera
    Eigen::Vector3f center = Eigen::Vector3f::Zero();        ///< of the box, on the plane
    Eigen::Vector2f half_extents = Eigen::Vector2f::Zero();  ///< of the box
    float unit = 0;                                          ///< metres a step of the outline's vertices
    std::uint32_t first = 0, last = 0;  ///< of StoredKeyframe::vertices; last is one past the end
    int plane = -1;                     ///< id of the map plane it went to; -1: none
    int keyframes = 1;                  ///< that saw it: its own, and those that handed theirs on to it
    int number = -1;                    ///< in Keyframe::regions; -1: of a keyframe that went
    int looks = 1;                      ///< that saw it, as StoredKeyframe::looks
    std::int64_t utime = 0;             ///< of the last of them
};

/// What one depth frame saw: a keyframe, or a look from near it.
struct StoredKeyframe {
    static constexpr std::size_t kMostLater = 12;  ///< as many tell all odds of a cell

    std::int64_t utime = 0;
    std::int64_t seen_utime = 0;            ///< of the last look that saw the same
    int looks = 1;                          ///< that did, at least 0.1 s apart
    std::vector<StoredRegion> regions;      ///< by falling number of inliers
    std::vector<std::int16_t> vertices;     ///< of all regions: a ring's size, then its x, y, ring after ring
    Sight sight;                            ///< regions as indexed here
    DepthNoise noise;                       ///< of the sensor
    std::optional<Pose> world_from_camera;  ///< the pose it is in the map with

    int id = -1;                                   ///< of the keyframe that it is, or was a look of,
    int number = 0;                                ///< Look::number,
    Pose keyframe_from_camera = Pose::Identity();  ///< and where it was taken from
    std::vector<Plane> sight_planes;               ///< of one whose regions went elsewhere, camera frame
    std::vector<StoredKeyframe> later;             ///< of a keyframe: looks, the oldest first

    /// More looks saw what it holds.
    void see_again(int looks_now, std::int64_t utime_now);
    /// Takes a look in; of too many, the oldest goes.
    void take_later(StoredKeyframe look);
};

/// f(view) of a keyframe and the looks from near it.
template <typename Keyframe, typename F>
void for_each_view(Keyframe& keyframe, const F& f) {
    f(keyframe);
    for (auto& look : keyframe.later) f(look);
}

/// Keeps what the map needs of a keyframe's regions; they must be valid. Outlines are packed as pack() does,
/// and it throws as that does.
StoredKeyframe stored(std::int64_t utime, const std::vector<PlanarRegion>& regions);

/// Planes of what its sight shows, camera frame.
std::vector<Plane> seen_planes(const StoredKeyframe& keyframe);

/// A region where it is in the world.
struct PlacedRegion {
    Plane plane;
    Box box;
    Moments moments;  ///< exact

    PlacedRegion(const Pose& world_from_camera, const StoredRegion& region_camera);
};

/// Takes another region's points into a region that shows the same plane: their moments, not their outline.
/// The region's plane is then the fit to all of them.
void take_points(StoredRegion& region_camera, const StoredRegion& other, const Pose& camera_from_other);

/// Appends a region of another keyframe as it is, its outline included. Sight does not know of it.
void take_region(StoredKeyframe& keyframe, const StoredRegion& other, const StoredKeyframe& owner,
                 const Pose& camera_from_other);

/// Depth of the region's points in the camera, on average, metres.
inline double mean_depth(const StoredRegion& region_camera) {
    return static_cast<double>(region_camera.mean.z());
}

/// The region's outline in the x and y of frame a, seen along its z; its box where it has no outline.
void outline_in(const Pose& a_from_box, const StoredRegion& region, const StoredKeyframe& owner,
                FlatPolygon& polygon_a);

/// Bytes it takes, by capacity, with its looks.
std::size_t memory_bytes(const StoredKeyframe& keyframe);

}  // namespace planemap::map
