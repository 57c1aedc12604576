// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/calibration.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "calibrate/flatness_watch.hpp"
#include "core/camera_file.hpp"
#include "core/depth_correction.hpp"
#include "core/number_text.hpp"
#include "core/validation.hpp"
#include "messages/process.hpp"
#include "run/input.hpp"
#include "run/progress.hpp"

namespace planemap {

namespace {

constexpr double kShown_m = 3;  // range at which a correction is told

/// One pass: the recording as `camera` corrects it.
graph::BentDepth learn(const CalibrationOptions& options, Calibration& calibration) {
    pipeline::PipelineOptions pipeline_options = options.pipeline;
    pipeline_options.with_octomap = false;
    pipeline_options.keep_estimates = false;
    pipeline_options.camera = calibration.camera;
    sensor::SourceOptions source = options.source;
    source.camera = calibration.camera;

    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, pipeline_options);
    const FlatnessWatch watch(pipeline.decoder());
    const std::unique_ptr<Input> input = open_input(options.input, bus, source);
    Progress progress(options.quiet);
    while (!messages::stop_requested() && input->feed()) {
        pipeline.settle();
        progress.show(*input, pipeline);
    }
    progress.end();
    if (messages::stop_requested()) throw std::runtime_error("stopped; nothing is written");
    if (!input->failure().empty()) throw std::runtime_error(input->failure());
    pipeline.finish();
    calibration.frames = input->frames();
    calibration.keyframes = pipeline.keyframes().keyframes.size();
    return pipeline.graph()->graph().bent_depth(calibration.camera, *calibration.camera.depth_correction,
                                                watch.flatness());
}

/// Of the recording, or what it is told. Throws std::runtime_error for a live camera: it cannot be read
/// again.
CameraInfo camera_of(const CalibrationOptions& options) {
    const auto source = sensor::open_source(options.input, options.source);
    if (source->is_live())
        throw std::runtime_error(options.input +
                                 ": a live camera cannot be read several times: record it (planemap-sensor "
                                 "with --record), and calibrate the recording");
    return options.source.camera.value_or(source->camera());
}

/// What no sensor is off by comes of wrong intrinsics, or of a recording that says too little.
void refuse_beyond_sensors(const std::string& input, const DepthCorrection& correction) {
    const auto [least, most] = std::minmax_element(correction.offsets.begin(), correction.offsets.end());
    const double largest = std::max(-*least, *most);
    if (largest <= DepthCorrection::kMost_per_m) return;
    throw std::runtime_error(input + ": its surfaces fit together best with an inverse depth off by " +
                             short_number_text(largest) + " per m, which no sensor is (at most " +
                             short_number_text(DepthCorrection::kMost_per_m) +
                             "): are camera.json's cameras right, and does it see walls from near and far?");
}

}  // namespace

void CalibrationOptions::validate() const {
    FieldErrors errors("options");
    errors.require(passes >= 1 && passes <= 20, "passes", passes, "1 to 20");
    errors.throw_if_any();
}

Calibration calibrate(const CalibrationOptions& options) {
    options.validate();
    Calibration calibration;
    calibration.camera = camera_of(options);
    calibration.camera.depth_correction.emplace();
    for (int i = 0; i < options.passes; ++i) {
        const graph::BentDepth found = learn(options, calibration);
        if (!found.is_known)
            throw std::runtime_error(options.input +
                                     ": says nothing of its depth: no surface was seen from two places");
        calibration.camera.depth_correction =
            composed(*calibration.camera.depth_correction, found.correction);
        calibration.passes.push_back(found);
        refuse_beyond_sensors(options.input, *calibration.camera.depth_correction);
    }
    return calibration;
}

std::string calibrated_file_text(const CameraInfo& camera, const std::filesystem::path& file) {
    if (file.empty()) return camera_file_text(camera);
    return with_depth_correction(file, *camera.depth_correction);
}

std::string correction_text(const DepthCorrection& correction) {
    std::string text = "Correction of readings of 3 m, cm (and its standard deviation), over the image:\n";
    for (std::size_t row = 0; row < DepthCorrection::kRows; ++row) {
        for (std::size_t column = 0; column < DepthCorrection::kColumns; ++column) {
            const std::size_t i = row * DepthCorrection::kColumns + column;
            const double z = kShown_m / (1 + kShown_m * correction.offsets[i]);
            char cell[40];
            std::snprintf(cell, sizeof cell, "  %+5.1f (%3.1f)", 100 * (z - kShown_m),
                          100 * kShown_m * kShown_m * correction.sigmas[i]);
            text += cell;
        }
        text += "\n";
    }
    return text;
}

}  // namespace planemap
