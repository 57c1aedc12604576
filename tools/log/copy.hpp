// SPDX-License-Identifier: BSD-3-Clause
// A log's events into a new one: all that are whole, or those of some time and channels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace planemap {

/// Which events go over.
struct LogSelection {
    double from_s = 0;           ///< seconds after the log's first event
    std::optional<double> to_s;  ///< events before it; nothing: to the end
    std::string channels;        ///< regular expression that matches the whole name; empty: all

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

struct CopiedLog {
    std::int64_t events = 0, left_out = 0;  ///< whole ones: copied, and not selected
    std::uint64_t bytes_skipped = 0;        ///< that belong to no whole event
    std::vector<std::string> complaints;    ///< what is damaged, a line each
};

/// Copies the selected events, their times as they were, their numbers anew from 0 without a gap (what a
/// reader finds its way back by after damage). `output` must not be there; it is whole or not there at all.
/// `progress` as summarise() has it. Throws std::runtime_error that names file and reason; also if not one
/// event would be in the new log.
CopiedLog copy_log(const std::filesystem::path& input, const std::filesystem::path& output,
                   const LogSelection& selection, const std::function<bool(double)>& progress);

}  // namespace planemap
