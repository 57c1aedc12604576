// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "core/frame_range.hpp"
#include "core/frame_source.hpp"

namespace planemap::sensor {

/// How an input is read.
struct SourceOptions {
    double max_color_gap_s = 0.02;  ///< depth without a colour image this near in time has no colour
    FrameRange frames{};            ///< what next() gives; as if the source had no others

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Opens `input`: a TUM-layout folder (see Dataset), or "sim:WORLD?key=value&..." (see SimulatedSource).
/// Throws std::runtime_error naming file and reason if there is nothing to read, and what to do about it;
/// std::invalid_argument for a bad camera.json or simulator name.
std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options = {});

}  // namespace planemap::sensor
