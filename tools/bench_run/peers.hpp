// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "results/table.hpp"

namespace planemap::bench_run {

/// CPU time of RgbdPlane on every 4th pixel of at most `most` frames spread over the first `frames` (0: all):
/// "frames" that it was run on, "median_ms", "total_ms". In a process of its own, whose "peak_rss_mb" is
/// known, too.
results::Json measure_rgbd_plane(const std::string& input, int frames, int most);

/// CPU time of OctoMap's own insertPointCloud(), at its best (discretize, lazy_eval), at the resolution that
/// planemap's has, of at most `most` frames spread over those that the trajectory (a file) has a pose for:
/// the same.
results::Json measure_octomap(const std::string& input, const std::filesystem::path& trajectory, int frames,
                              int most);

}  // namespace planemap::bench_run
