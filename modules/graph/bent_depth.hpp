// SPDX-License-Identifier: BSD-3-Clause
// What a sensor's depth is off by, learnt from walls that are flat and seen from near and far.
#pragma once

#include <Eigen/Core>

#include "core/camera.hpp"

namespace planemap::graph {

struct OptimisationTask;

/// What single depth images say, by the flatness of what is in them: the offsets f for which
/// information * f = pull, as far as the information goes. (Fields that are linear over the image turn one
/// plane into another: of them single images say nothing.)
struct Flatness {
    using Field = Eigen::Matrix<double, DepthCorrection::kNodes, 1>;
    using Information = Eigen::Matrix<double, DepthCorrection::kNodes, DepthCorrection::kNodes>;

    Information information = Information::Zero();
    Field pull = Field::Zero();
    int regions = 0;
};

/// What a graph says of its sensor's depth.
struct BentDepth {
    /// Of the readings as the graph got them, on top of what corrected them before. Directions in which the
    /// graph says nothing certain are zero; the standard deviations are of all offsets together.
    DepthCorrection correction;
    int sightings = 0;      ///< of landmarks that were seen more than once
    double rms_before = 0;  ///< of the sightings' distances to their landmarks, standard deviations,
    double rms_after = 0;   ///< and with the correction
    bool is_known = false;  ///< the graph says anything at all
};

/// Finds poses, landmarks and the offsets of inverse depth together, all by least squares, the offsets with a
/// prior of zero, 6 cm at 3 m (their sum with what was corrected before, `so_far`). `camera` is the sensor's,
/// as it senses; its depth_correction does not count. The task stays as it is. `flatness` is of the same
/// readings.
BentDepth bent_depth(const OptimisationTask& task, const CameraInfo& camera, const DepthCorrection& so_far,
                     const Flatness& flatness = {});

}  // namespace planemap::graph
