// SPDX-License-Identifier: BSD-3-Clause
// One row of the benchmark's table: a method on a sequence.
#pragma once

#include <string>
#include <vector>

#include "bench_segmentation/consistency.hpp"
#include "bench_segmentation/methods.hpp"
#include "bench_segmentation/metrics.hpp"
#include "bench_segmentation/sequences.hpp"
#include "results/table.hpp"

namespace planemap::bench {

using results::Json;

/// What a method did on a sequence so far.
struct Row {
    std::string sequence;
    MethodName method;
    std::vector<double> ms;  ///< of each frame that was timed
    FrameScore score;
    MatchScore match;
    WorldPlanes world_planes;
    bool has_truth = false, has_poses = false;

    /// Takes in one frame, timed or not. `normals` are the frame's local_normals().
    void add(std::optional<double> frame_ms, const BenchFrame& frame, const CameraInfo& camera,
             const Image<Eigen::Vector3f>& normals, const segmentation::Segmentation& segmentation);
};

/// A row as --json writes it; null where a sequence has no truth or no poses.
Json to_json(const Row& row);

/// What people see of a row's JSON.
const results::Table& table();

}  // namespace planemap::bench
