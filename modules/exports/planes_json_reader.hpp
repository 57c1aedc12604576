// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/plane_map.hpp"

namespace planemap::exports {

/// The map of a planes.json, of this planemap or an earlier one: what planes_json() wrote, to its rounding
/// (a micrometre; outlines to the millimetre that a map keeps). What an earlier one did not write is not
/// known: no keyframes, nothing inferred. `rms`, `inliers` and `area` that are null are not a number. Throws
/// std::runtime_error if the file cannot be read or is over 32 MB, and std::invalid_argument with one line
/// that names file, field ("planes[3].normal"), its value and what is allowed; syntax errors with line and
/// column.
PlaneMap read_planes_json(const std::filesystem::path& file);

}  // namespace planemap::exports
