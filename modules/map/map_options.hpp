// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"

namespace planemap::map {

struct MapOptions {
    double merge_angle_deg = 10;     ///< largest angle between merged regions (paper section 2.3)
    double merge_distance_m = 0.05;  ///< largest distance between their planes, where they are (section 2.3)
    double merge_gap_m = 0.5;        ///< largest gap between their boxes (section 2.3)

    DepthNoise noise;            ///< of the depth sensor: a far, noisy view weighs less in a plane's fit
    double pose_sigma_m = 0.02;  ///< error of keyframe poses; below it, less sensor noise gains no weight
    double agreement_m = 0.01;   ///< a view off its plane by much more (and the sensor's noise) loses weight

    double outline_cell_m = 0.025;      ///< raster on which a plane's shape is collected
    double outline_tolerance_m = 0.04;  ///< simplification of the outline
    double outline_min_ring_m2 = 0.01;  ///< smaller parts and holes of an outline are left out
    int outline_min_hits = 1;           ///< evidence a cell needs: 1 for a far view, up to 4 for a near one
    double see_through_m = 0.05;        ///< a view past a cell by more (and 2 sigma) is evidence against it

    double adjacency_gap_m = 0.15;     ///< planes meet where both outlines come this near to the common line
    double adjacency_angle_deg = 15;   ///< flatter pairs get no intersection line
    double adjacency_length_m = 0.25;  ///< shorter intersection lines are left out

    double min_area_m2 = 0.05;    ///< smaller planes are kept, but are not in map()
    double min_single_m2 = 0.25;  ///< the same for planes that only one keyframe saw
    int min_keyframes = 1;        ///< planes seen by fewer keyframes are kept, but are not in map()

    double moved_m = 0.002;     ///< keyframes that moved less than this,
    double moved_deg = 0.05;    ///< and turned less than this, do not cause a rebuild
    double max_extent_m = 200;  ///< a plane does not grow longer than this
    int fold_after = 0;  ///< keyframes older than so many newer ones are taken not to move any more, and
                         ///< their regions are folded into the planes; 0: never
    int threads = 2;     ///< of a rebuild; they do not change the result

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

}  // namespace planemap::map
