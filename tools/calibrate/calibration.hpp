// SPDX-License-Identifier: BSD-3-Clause
// A sensor's depth correction, learnt from a recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "graph/bent_depth.hpp"
#include "pipeline/pipeline.hpp"
#include "sensor/source.hpp"

namespace planemap {

struct CalibrationOptions {
    std::string input;
    sensor::SourceOptions source;        ///< its camera is that of all passes, whatever corrected it before
    pipeline::PipelineOptions pipeline;  ///< its octomap, poses and camera do not count
    int passes = 4;
    bool quiet = false;

    /// Throws std::invalid_argument.
    void validate() const;
};

/// What a recording says of its sensor.
struct Calibration {
    CameraInfo camera;                     ///< with the correction
    std::vector<graph::BentDepth> passes;  ///< the correction of each on top of those before it
    std::int64_t frames = 0;               ///< of the last pass
    std::size_t keyframes = 0;
};

/// Maps the recording several times, each time with what the pass before learnt: everything that was made of
/// bent depth, the odometry too, is made anew. Throws std::runtime_error or std::invalid_argument naming the
/// input, if it cannot be read or says nothing of its depth.
Calibration calibrate(const CalibrationOptions& options);

/// The text of a camera.json: that of `file` with the correction in it, all else as it is; without a file (an
/// empty name) what is known of the camera.
std::string calibrated_file_text(const CameraInfo& camera, const std::filesystem::path& file);

/// The correction as people read it: what it does to readings of 3 m, centimetres, and how certain that is.
std::string correction_text(const DepthCorrection& correction);

}  // namespace planemap
