// SPDX-License-Identifier: BSD-3-Clause
// Whether a map can be believed, by the depth that it was made of alone: surfaces that stand in it twice,
// surfaces that float where the camera looked through, and readings that no surface explains. Nothing here
// asks only what lies near a plane, as figures do that a doubled or a floating surface cannot worsen.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "evaluate/depth_views.hpp"
#include "evaluate/map_faces.hpp"

namespace planemap::evaluation {

/// A view and where it was.
struct PosedView {
    const DepthView* view = nullptr;
    Pose world_from_color = Pose::Identity();
};

struct SoundnessLimits {
    double doubled_m = 0.15, doubled_deg = 12;         ///< of two outlines that say one surface twice
    int least_views = 3;                               ///< that see both: then they are two surfaces
    double behind_m = 0.05, behind_sigmas = 3;         ///< of a reading that was seen through a plane
    double explained_m = 0.015, explained_sigmas = 3;  ///< of a reading to the plane that explains it
    double close_m = 0.02, near_m = 0.05;              ///< of readings that lie close to a plane, near it

    /// How far a reading with this noise may be from the plane that explains it.
    double band_m(double sigma_m) const;
};

/// A depth reading, held against the map.
struct JudgedReading {
    Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
    Rgb color;
    double range_m = 0;             ///< along the optical axis
    const MapFace* face = nullptr;  ///< the nearest whose outline it is on, if it is explained or near; else
                                    ///< nullptr. Lives as long as the call
    double distance_m = 0;          ///< to that, signed: positive before it
    bool is_explained = false;      ///< within the band of it
    bool is_near = false;           ///< within 5 cm of it
};
using ReadingListener = std::function<void(const JudgedReading&)>;

/// How many readings there are, and how many of them lie by a plane, on its outline.
struct ReadingCounts {
    std::int64_t readings = 0;
    std::int64_t close = 0;      ///< within 2 cm
    std::int64_t explained = 0;  ///< within max(1.5 cm, 3 sigma)
    std::int64_t near = 0;       ///< within 5 cm

    /// Of the readings; nothing without any.
    std::optional<double> share_of(std::int64_t ReadingCounts::*count) const;
    void operator+=(const ReadingCounts& other);
};

/// Distances of readings to the planes that explain them.
struct Residuals {
    std::int64_t count = 0;
    double mean_m = 0;  ///< positive: the readings lie before the plane
    double rms_m = 0;
};

/// Two planes that say one surface.
struct DoubledPair {
    int id_a = -1, id_b = -1;
    double area_m2 = 0;  ///< of the smaller one's outline that the other says again
};

struct PlaneSoundness {
    int id = -1;
    double area_m2 = 0;       ///< of the outline
    double seen_m2 = 0;       ///< of it, what a view has a reading on the ray of
    double floating_m2 = 0;   ///< of that, what more than half of these views looked through
    double confirmed_m2 = 0;  ///< of that, what a view has a reading of that the plane explains
    Residuals residuals;      ///< of the readings that the plane explains, as the nearest
};

struct RangeSoundness {
    double from_m = 0, to_m = 0;  ///< depth of the readings
    ReadingCounts counts;
    Residuals residuals;  ///< of those that are explained
};

struct Soundness {
    std::size_t views = 0;
    double area_m2 = 0;
    double doubled_m2 = 0;  ///< each point of a smaller outline once
    double seen_m2 = 0, floating_m2 = 0, confirmed_m2 = 0;
    ReadingCounts counts;
    Residuals residuals;                   ///< of those that are explained
    std::vector<PlaneSoundness> planes;    ///< in the map's order
    std::vector<DoubledPair> doubled;      ///< from the largest
    std::vector<RangeSoundness> by_range;  ///< steps of 1 m, those with readings
    std::vector<double> outline_gaps;      ///< from lines where planes meet to outlines, see outline_gaps()

    /// Shares; nothing where there is nothing to have a share of.
    std::optional<double> doubled_share() const;
    std::optional<double> floating_share() const;
    std::optional<double> confirmed_share() const;  ///< of all of the outlines' area
};

/// Holds a map against views, all in one world. Of outlines, cells of 2.5 cm are compared.
/// - doubled: cells of the smaller of two outlines that lie within 15 cm of the other, on its outline, where
///   the two face the same way within 12 deg. Two that three or more views saw side by side are two surfaces
///   (a board before a wall): readings within 2 sigma of either that are neighbours in the image, where the
///   planes are 6 sigma apart, so that noise does not take one for the other.
/// - floating: cells for which more than half of the views that have a reading on their ray have it more than
///   max(5 cm, 3 sigma) behind the plane.
/// - confirmed: cells that a view has a reading on the ray of within max(1.5 cm, 3 sigma) of the plane.
/// The listener is called for each reading: view by view, row by row.
Soundness soundness(const PlaneMap& map, const std::vector<PosedView>& views,
                    const SoundnessLimits& limits = {}, const ReadingListener& listener = {});

}  // namespace planemap::evaluation
