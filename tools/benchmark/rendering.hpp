// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "benchmark/sequences.hpp"

namespace planemap::benchmark {

/// Where a program may keep what it can make again.
std::filesystem::path default_cache_folder(const std::string& program);

/// Renders the first `frames` (0: all) of a simulated sequence to a log in the cache (JPEG and zipped depth),
/// with its truth beside it (.txt), unless a log of the same simulation is there already: rendering takes
/// longer than what is measured. A log is known by the simulator's name and by what three of its frames and
/// all its poses look like now, so that a change of the simulator is seen; logs of an earlier state are
/// removed. Works in a process of its own. Calls `on_frame` with the frames rendered so far. Returns the log;
/// throws DataMissing, or std::runtime_error naming what went wrong.
std::filesystem::path rendered_log(const SequenceInfo& sequence, const std::filesystem::path& data,
                                   const std::filesystem::path& cache, std::int64_t frames,
                                   const std::function<void(std::int64_t)>& on_frame);

}  // namespace planemap::benchmark
