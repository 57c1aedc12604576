// SPDX-License-Identifier: BSD-3-Clause
// A map of planes beside the true planes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/plane_map.hpp"
#include "evaluate/plane_raster.hpp"

namespace planemap::evaluation {

inline constexpr double kMaxAngle_deg = 10,
                        kMaxDistance_m = 0.05;  ///< the paper's, for one and the same plane
inline constexpr double kLeastArea_m2 = 0.5;    ///< of a plane that counts

/// A plane as far as the camera has seen it.
struct TruePlane {
    std::string name;  ///< of the surface that most of it is; "+2" counts others in the same plane
    Plane plane;       ///< world frame; the normal points to the side that can be seen
    Pose world_from_plane = Pose::Identity();  ///< z is the normal; frame of the raster
    PlaneRaster visible;                       ///< at least one cell
    PlaneRaster material;                      ///< all of the plane, seen or not; of the size of `visible`

    /// Middle of the visible surface, world frame.
    Eigen::Vector3d centre() const;
};

/// What became of one true plane.
struct TruePlaneVerdict {
    std::string name;
    double area = 0;        ///< visible, square metres
    bool found = false;     ///< a map plane covers at least half of it, see overlap()
    int best = -1;          ///< id of the map plane that covers most of it; -1: none
    double covered = 0;     ///< share of it that `best` covers
    double angle_deg = 0;   ///< between `best` and the true plane
    double distance_m = 0;  ///< from the true plane to `best` at the middle of the visible surface, signed
    /// Ids of the map planes that belong to it (that overlap no other true plane more) by more than
    /// kLeastArea_m2: more than one means that it is split.
    std::vector<int> parts;
    /// Of the visible surface and the outlines of `best` and all that belong to it; of those, what is on
    /// other parts of the same plane is left out.
    double iou = 0;
    double common_m2 = 0, united_m2 = 0;  ///< the two areas of iou
    bool counts() const { return area > kLeastArea_m2; }
};

/// A map plane of which less than half is on any true plane.
struct SpuriousPlane {
    int id = -1;
    double area = 0;           ///< of its outline, square metres
    double on_true_plane = 0;  ///< share of it
};

/// A map plane that is on several true planes, however small.
struct SharedPlane {
    struct Share {
        std::size_t plane = 0;  ///< index into Judgement::planes
        double area = 0;        ///< of the overlap, square metres
    };
    int id = -1;
    std::vector<Share> shares;  ///< of more than 0.05 m2, from the largest
};

/// A distance (metres) or an angle (degrees) between two found planes, by index into Judgement::planes.
struct PairMeasure {
    std::size_t a = 0, b = 0;
    double truth = 0, map = 0;
    double error() const;
};

/// Two true planes that the mapper's rules take for one: within 10 deg, 5 cm and 0.5 m.
struct LookAlikes {
    std::size_t a = 0, b = 0;
    double angle_deg = 0, distance_m = 0;
};

struct Judgement {
    std::vector<TruePlaneVerdict> planes;  ///< in the order of the truth
    std::vector<SpuriousPlane> spurious;   ///< larger than kLeastArea_m2
    std::vector<SharedPlane> shared;       ///< on two true planes or more
    std::vector<PairMeasure> distances;    ///< parallel found planes (within 5 deg), 0.3 m apart or more
    std::vector<PairMeasure> angles;       ///< all other found planes whose middles are within 6 m
    std::vector<LookAlikes> look_alikes;   ///< of those that count

    std::size_t seen() const;   ///< true planes that count
    std::size_t found() const;  ///< of those
    std::size_t split() const;  ///< map planes too many on those
    /// Over all found planes together; nothing if none is found.
    std::optional<double> outline_iou() const;
};

/// Compares a map with the truth. `truth_from_map` lays the map's world on the truth's; distances and angles
/// between planes do not depend on it, but which plane is which does. A map plane overlaps a true one where
/// its outline, projected onto the true plane, is on the visible surface and the two are within 5 cm; nowhere
/// if their normals are more than 10 deg apart.
Judgement judge(const std::vector<TruePlane>& truth, const PlaneMap& map, const Pose& truth_from_map);

}  // namespace planemap::evaluation
