// SPDX-License-Identifier: BSD-3-Clause
// Methods on sequences, each row in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "bench_odometry/methods.hpp"
#include "bench_odometry/row.hpp"
#include "benchmark/program.hpp"

namespace planemap::bench_odometry {

using benchmark::SequenceInfo;

/// Recordings and simulated walks.
const std::vector<SequenceInfo>& known_sequences();

/// A sequence that is there to be run.
struct Sequence {
    std::string name;
    std::string input;                ///< folder or log, as planemap-run takes it
    std::optional<Trajectory> truth;  ///< of the colour camera; nothing if it is not known
};

struct BenchmarkOptions : benchmark::Options {
    int slow_frames = 300;        ///< at most this many for a method that is slow; 0: as the others
    std::filesystem::path cache;  ///< folder of the logs of simulated sequences; made if it is not there
    pipeline::PipelineOptions pipeline;  ///< of the project's own methods

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

class Benchmark {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit Benchmark(const BenchmarkOptions& options);

    /// Finds a recording, or renders a simulated sequence, see rendered_log(). Throws DataMissing, or
    /// std::runtime_error naming what went wrong.
    Sequence open(const SequenceInfo& info) const;
    /// Runs one method on one sequence. Throws std::runtime_error naming both if it failed.
    Row run(const Sequence& sequence, const MethodInfo& method) const;

  private:
    BenchmarkOptions options_;
};

}  // namespace planemap::bench_odometry
