// SPDX-License-Identifier: BSD-3-Clause
// How sequences are named and found.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace planemap::benchmark {

/// Folder of the sample data, as the tests find it: $PLANEMAP_DATA, or ../shared/data beside the source.
std::filesystem::path default_data_folder();

/// A sequence by name, as --sequences takes it.
struct SequenceInfo {
    std::string name;
    std::string what;       ///< one line for --help
    std::string simulator;  ///< what follows "sim:", see SimulatorOptions; empty: a recording
    std::string poses;      ///< a recorded trajectory for it, a file in the data folder; empty: its own walk
    int frames = 0;         ///< for a benchmark that takes frames from all over it, by default; 0: its own
};

/// The recordings of the sample data, and then a benchmark's own sequences.
std::vector<SequenceInfo> with_recordings(const std::vector<SequenceInfo>& own);

enum class Unknown { kRefused, kIsPath };

/// Reads "redkitchen,sim:office?seed=1..5": names among `known`, simulators, of which a range of a parameter
/// makes as many as it has numbers, and, where Unknown::kIsPath allows, folders and logs. Throws
/// std::invalid_argument for an empty list, a range that runs backwards or is longer than 1000, a simulator
/// that there is not, and another unknown name, listing what there is.
std::vector<SequenceInfo> parse_sequences(const std::string& list, const std::vector<SequenceInfo>& known,
                                          Unknown unknown = Unknown::kRefused);

/// A sequence's data is not there; what() names the file.
struct DataMissing : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What planemap-run is given for a sequence: a simulator's name, a folder of `data`, or any other folder or
/// log. Throws DataMissing.
std::string input_of(const SequenceInfo& sequence, const std::filesystem::path& data);

/// A sequence's name with what no file name should have replaced by "-".
std::string file_name_of(const std::string& sequence);

}  // namespace planemap::benchmark
