// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace planemap {

/// What a run's results are worth beside those of another run into the same folder.
struct RunWorth {
    std::int64_t frames = 0, tracked = 0;
    bool interrupted = false;  ///< ended before the end of its input

    /// Fewer than half of the frames, or none at all: the results are of a part of the input that nobody
    /// chose.
    bool tracked_few() const { return tracked == 0 || 2 * tracked < frames; }
    bool is_sound() const { return !interrupted && !tracked_few(); }
};

/// From a report's "frames", "tracked" and "interrupted"; nothing if it is no report. Reports of versions
/// that did not tell are of runs that were not interrupted.
std::optional<RunWorth> worth_of(const nlohmann::ordered_json& report);

/// Of the run whose report.json is in the folder; nothing if there is none that can be read.
std::optional<RunWorth> worth_in(const std::filesystem::path& folder);

/// Why a run's results must not take the place of an earlier run's, as words to follow a colon; empty if they
/// may: a sound run replaces any, another one only what is not sound either and has no more tracked frames.
/// Where nothing is known of the earlier run, it is kept.
std::string why_not_replace(const RunWorth& run, const std::optional<RunWorth>& earlier);

}  // namespace planemap
