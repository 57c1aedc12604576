// SPDX-License-Identifier: BSD-3-Clause
// Moments that a camera or its driver make bad, and what odometry says of them: planemap-bench-odometry
// --bad-moments.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench_odometry/bad_run.hpp"
#include "bench_odometry/benchmark.hpp"
#include "benchmark/report.hpp"

namespace planemap::bench_odometry {

/// Part of a sequence that moments are made of.
struct BadSequence {
    SequenceInfo sequence;
    std::size_t from = 0, frames = 0;  ///< the part: its first frame, and how many
    std::size_t first = 0;             ///< of these, the first that is disturbed
    std::string moments;               ///< comma-separated; empty: all
    std::size_t walk = 0;              ///< where there are returns: frames of the walk before them; else 0
};
const std::vector<BadSequence>& bad_sequences();

/// Their SequenceInfos, as --sequences takes them.
std::vector<SequenceInfo> bad_sequence_infos();

/// What odometry said of the frames from the first disturbed one on.
struct MomentRow {
    std::string sequence, moment;
    int frames = 0;
    int wrong = 0;
    int no_pose = 0;
    int degenerate = 0, stale = 0;
    int unjudged = 0;                    ///< with a pose, but there is no truth or nothing to hold it against
    int parts = 0;                       ///< begun since
    double worst_m = 0, worst_deg = 0;   ///< largest errors of frames that have a pose and are not admitted
    int nees_count = 0, nees_below = 0;  ///< frames whose NEES is known, and those below kNees95
};
MomentRow make_row(const Told& told, std::size_t first);

/// What became of returns after a pause.
struct ReturnsRow {
    std::string sequence;
    int cuts = 0;
    int found = 0;  ///< placed right
    int wrong = 0;  ///< placed wrong
};
/// Judges `cuts` returns of `frames` frames each, the first at frame `walk`. A return is placed when a frame
/// of it has a pose against a keyframe from before it, or a loop closure ties a keyframe of it to one; wrong,
/// when one such relation is false as evaluation::judge_closure() has it.
ReturnsRow make_returns_row(const Told& told, std::size_t walk, int cuts, std::size_t frames);

/// Runs the moments named (empty: all) of the sequences named, each in a process of its own, and reports a
/// table and the sums. options.frames is not asked. Throws std::invalid_argument for an unknown name.
void print_bad_moments(const BenchmarkOptions& options, const std::string& sequences,
                       const std::string& moments, benchmark::Report& report);

}  // namespace planemap::bench_odometry
