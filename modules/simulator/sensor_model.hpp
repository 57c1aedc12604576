// SPDX-License-Identifier: BSD-3-Clause
// What a depth sensor and a colour camera make of a view.
#pragma once

#include "simulator/random.hpp"
#include "simulator/renderer.hpp"
#include "simulator/sensor_profile.hpp"

namespace planemap::simulator {

/// A depth camera; the Kinect's, if nothing is said (Khoshelham and Elberink 2012; Nguyen et al. 2012).
struct DepthSensorOptions {
    bool noise = true;  ///< false: exact depth within the range, rounded to units; edges and holes go with it
    Principle principle = Principle::kStructuredLight;
    bool edges = true;  ///< jitter and shadow of structured light, flying pixels of time of flight, bleeding
                        ///< and occlusion of stereo, smearing of a lidar
    bool holes = true;  ///< at grazing angles, behind panes that are looked through aslant, and, of stereo,
                        ///< on bare walls
    double units_per_metre = 1000;    ///< of the raw depth
    double min_m = 0.5, max_m = 4.0;  ///< range; nothing outside
    DepthNoise sigma;                 ///< standard deviation of depth, quantisation included
    double baseline_m = 0.075;        ///< from the camera to the projector, along the camera's x
    double disparity_steps = 8;       ///< disparity is measured in steps of 1 / this pixel
    double edge_jitter = 0.25;     ///< probability that a reading comes from the next pixel left, and right,
                                   ///< up and down: it shows at edges
    double grazing_from_deg = 76;  ///< angle between ray and normal from which readings go missing
    double grazing_to_deg = 84;    ///< angle from which there are none

    void validate() const;
};

/// Raw depth of a view; black surfaces have none. Depends on view, options and seed alone.
DepthImage sense_depth(const World& world, const View& view, const DepthSensorOptions& options,
                       const GaussianTable& gaussian, std::uint64_t seed);

/// The sum of `exposures` shaded views as an image: their mean, a soft lens (1 2 1 both ways), and Gaussian
/// noise of `noise_levels` (of 255) in each channel. At most 16 exposures.
RgbImage sense_color(const LaneImage& sum, int exposures, double noise_levels, const GaussianTable& gaussian,
                     std::uint64_t seed);

}  // namespace planemap::simulator
