// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "graph/options.hpp"

namespace planemap::graph {

/// When a graph is to be optimised, and whether the result of an optimisation still holds. It knows no graph:
/// it is told what happens.
class Schedule {
  public:
    /// The options must be valid.
    explicit Schedule(const GraphOptions& options) : options_(options) {}

    /// What a new keyframe brought.
    struct Addition {
        int nodes = 0;              ///< in the graph, with it
        double disagreement = 0;    ///< of its planes with the landmarks, standard deviations
        bool new_loops = false;     ///< there are loop closures that no optimisation knows
        double worst_new_loop = 0;  ///< whitened error of the worst of these
    };
    void keyframe_added(const Addition& addition);
    /// Others than before see a landmark: how far they disagree, standard deviations.
    void landmarks_changed(double disagreement);

    bool is_due() const { return is_due_; }
    /// Between start() and end(): nodes must keep their numbers.
    bool is_running() const { return is_running_; }

    /// An optimisation starts with all that is there; one at a time. Returns what to give to end().
    int start();
    /// Whether the result may be applied. Not when a part of the graph was moved meanwhile: then another
    /// optimisation is due.
    bool end(int started);

    /// A part of the graph was moved as a whole.
    void part_moved() { ++parts_moved_; }

    /// Whether a loop closure of this whitened error is so far from the poses that the kernel would not let
    /// it pull.
    bool is_far(double whitened_error) const;

  private:
    bool asks(const Addition& addition) const;

    GraphOptions options_;
    double disagreement_ = 0;  ///< the largest since the last optimisation
    int since_started_ = 0;    ///< keyframes since the last optimisation
    bool is_due_ = false;
    bool is_running_ = false;
    int parts_moved_ = 0;
};

}  // namespace planemap::graph
