// SPDX-License-Identifier: BSD-3-Clause
// The sequences that methods are compared on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.hpp"

namespace planemap::bench_odometry {

/// A sequence by name, as --sequences takes it.
struct SequenceInfo {
    std::string name;
    std::string what;       ///< one line for --help
    std::string simulator;  ///< what follows "sim:", see SimulatorOptions; empty: a folder of recordings
    std::string poses;      ///< its recorded trajectory, a file in the data folder; empty: the world's walk
};
const std::vector<SequenceInfo>& known_sequences();

/// Reads "redkitchen,sim:kt0"; throws std::invalid_argument for an unknown name, listing what there is.
std::vector<SequenceInfo> parse_sequences(const std::string& list);

/// A sequence that is there to be run.
struct Sequence {
    std::string name;
    std::string input;                ///< folder or log, as planemap-run takes it
    std::optional<Trajectory> truth;  ///< of the colour camera; nothing if it is not known
};

struct SequenceOptions {
    std::filesystem::path data;   ///< folder of the recordings
    std::filesystem::path cache;  ///< folder of the logs of simulated sequences; made if it is not there
    std::int64_t frames = 0;      ///< that will be run; 0: all
};

/// Finds a recording, or renders a simulated sequence to a log in the cache (JPEG and zipped depth) unless a
/// log of the same simulation is there already: rendering takes longer than what is measured. A log is known
/// by the simulator's name and by what three of its frames and all its poses look like now, so that a change
/// of the simulator is seen; logs of an earlier state are removed. Calls `on_frame` with the frames rendered
/// so far. Returns nothing, and why in `missing`, if the data is not there; throws std::runtime_error naming
/// what went wrong.
std::optional<Sequence> open_sequence(const SequenceInfo& info, const SequenceOptions& options,
                                      const std::function<void(std::int64_t)>& on_frame,
                                      std::string& missing);

}  // namespace planemap::bench_odometry
