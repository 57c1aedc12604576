// SPDX-License-Identifier: BSD-3-Clause
// The sequences that maps are made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench_map/truth.hpp"

namespace planemap::bench_map {

/// What --sequences is by default.
extern const char* const kDefaultSequences;

/// Splits a comma-separated list; "sim:office?seed=1..5" becomes five. Throws std::invalid_argument for an
/// empty list or a range that runs backwards or is longer than 1000.
std::vector<std::string> parse_sequences(const std::string& list);

/// What planemap-run is given for a sequence: a sim:... name as it is (sim:building with its own walk),
/// a folder of `data`, or any other folder or log. Nothing, and why in `missing`, if there is no such thing.
std::optional<std::string> input_of(const std::string& sequence, const std::filesystem::path& data,
                                    std::string& missing);

/// The planes that a simulated sequence shows in every fifth of its first `frames` frames (0: all) within the
/// sensor's range; nothing for other inputs.
std::optional<std::vector<TruePlane>> true_planes(const std::string& input, std::int64_t frames);

}  // namespace planemap::bench_map
