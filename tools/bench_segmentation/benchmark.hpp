// SPDX-License-Identifier: BSD-3-Clause
// Methods on sequences, frame by frame.
#pragma once

#include <filesystem>

#include "bench_segmentation/row.hpp"
#include "benchmark/program.hpp"

namespace planemap::bench {

struct BenchmarkOptions : benchmark::Options {
    int slow_frames = 20;            ///< at most this many for a method that is slow
    std::filesystem::path overlays;  ///< folder for pictures; empty: none
    int overlay_every = 10;          ///< a picture of every n-th frame that is run

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

class Benchmark {
  public:
    explicit Benchmark(const BenchmarkOptions& options);

    /// Runs every method on a sequence and returns a row each, after one named "truth" for the truth itself
    /// where there is one: what nothing can beat. Throws as open_sequence().
    std::vector<Row> run(const SequenceInfo& info, const std::vector<MethodName>& methods) const;

  private:
    struct Contender;
    struct Run;
    void run_frame(Run& run, std::size_t index, bool draw) const;
    void draw(const Sequence& sequence, std::size_t index, const std::string& name, const DepthImage& depth,
              const segmentation::Segmentation& segmentation) const;

    BenchmarkOptions options_;
};

/// The truth as a method that is always right would return it.
segmentation::Segmentation as_segmentation(const Truth& truth);

}  // namespace planemap::bench
