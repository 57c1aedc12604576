// SPDX-License-Identifier: BSD-3-Clause
// Methods on sequences, each row in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "bench_odometry/methods.hpp"
#include "bench_odometry/row.hpp"
#include "bench_odometry/sequences.hpp"

namespace planemap::bench_odometry {

struct BenchmarkOptions {
    int frames = 0;                     ///< from each sequence's start; 0: all
    int slow_frames = 300;              ///< at most this many for a method that is slow; 0: as the others
    std::filesystem::path data, cache;  ///< see SequenceOptions
    PipelineOptions pipeline;           ///< of the project's own methods
    bool quiet = false;                 ///< no progress on stderr

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

class Benchmark {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit Benchmark(const BenchmarkOptions& options);

    /// Opens a sequence; nothing, and why in `missing`, if its data is not there.
    std::optional<Sequence> open(const SequenceInfo& info, std::string& missing) const;
    /// Runs one method on one sequence. Throws std::runtime_error naming both if it failed.
    Row run(const Sequence& sequence, const MethodInfo& method) const;

  private:
    BenchmarkOptions options_;
};

}  // namespace planemap::bench_odometry
