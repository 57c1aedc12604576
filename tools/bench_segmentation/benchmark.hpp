// SPDX-License-Identifier: BSD-3-Clause
// Methods on sequences, frame by frame.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench_segmentation/row.hpp"

namespace planemap::bench {

struct BenchmarkOptions {
    int frames = 0;                  ///< a sequence; 0: each sequence's own
    int slow_frames = 20;            ///< at most this many for a method that is slow
    std::filesystem::path data;      ///< folder of the recordings
    std::filesystem::path overlays;  ///< folder for pictures; empty: none
    int overlay_every = 10;          ///< a picture of every n-th frame that is run
    bool quiet = false;              ///< no progress on stderr

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

class Benchmark {
  public:
    explicit Benchmark(const BenchmarkOptions& options);

    /// Runs every method on a sequence and returns a row each, after one named "truth" for the truth itself
    /// where there is one: what nothing can beat. Without its data it returns nothing, and says why in
    /// `missing`.
    std::vector<Row> run(const SequenceInfo& info, const std::vector<MethodName>& methods,
                         std::string& missing);

  private:
    struct Contender;
    void run_frame(const Sequence& sequence, std::size_t index, bool draw, std::vector<Contender>& contenders,
                   Row& truth);
    void draw(const Sequence& sequence, std::size_t index, const std::string& name, const DepthImage& depth,
              const segmentation::Segmentation& segmentation) const;
    void show_progress(const Sequence& sequence, std::size_t index, const MethodName& method);
    void end_progress();

    BenchmarkOptions options_;
    bool drawn_ = false;
};

}  // namespace planemap::bench
