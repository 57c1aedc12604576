// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/camera.hpp"
#include "core/keyframe.hpp"
#include "core/surfaces.hpp"
#include "graph/bent_depth.hpp"
#include "graph/loop_closure.hpp"
#include "graph/options.hpp"

namespace planemap::graph {

struct OptimisationTask;

/// What a graph did without.
struct GraphCounts {
    std::size_t replaced = 0;              ///< keyframes that went for newer ones of the same place
    std::size_t features_left_out = 0;     ///< features without a point before the camera, or one too many
    std::size_t failed_optimisations = 0;  ///< in which the solver gave up; the poses stayed
};

/// One optimisation of a PoseGraph as it was when prepared, with a copy of all that it needs: run() may run
/// on another thread while the graph grows.
class GraphOptimisation {
  public:
    explicit GraphOptimisation(std::unique_ptr<OptimisationTask> task);
    ~GraphOptimisation();
    GraphOptimisation(GraphOptimisation&&) noexcept;
    GraphOptimisation& operator=(GraphOptimisation&&) noexcept;

    /// Call it once; then give it back to PoseGraph::apply().
    void run();
    const OptimisationTask& task() const { return *task_; }

  private:
    std::unique_ptr<OptimisationTask> task_;
};

/// Keyframes, the edges between them, and the poses that fit all edges best. What odometry and loop closures
/// tie together is a component, with a world frame of its own: the odom frame of its first keyframe, which
/// never moves. After a loss, a restart, or a stamp that goes back a component begins; when a loop closure
/// ties two, the younger one becomes part of the older. The same keyframes in the same order give the same
/// result.
///
/// Memory grows with the places seen, not with time: where a camera comes again and again, a keyframe that
/// looks like max_alike newer ones goes, once it is not among the newest 24. Its edges and what it saw of
/// landmarks go over to the nearest keyframe that it is tied to, its id is no longer in the trajectory, and
/// an edge of a later keyframe from it leads from that one. The older goes, so that changed light or a
/// changed room replaces what was.
class PoseGraph {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit PoseGraph(GraphOptions options = {});
    ~PoseGraph();
    PoseGraph(PoseGraph&&) noexcept;
    PoseGraph& operator=(PoseGraph&&) noexcept;

    /// Adds a keyframe, looks for loop closures, optimises if one was found. Throws std::invalid_argument
    /// naming the field, and leaves the graph as it was, for a keyframe whose id does not follow the last
    /// one's (see expects()), or with values that are not finite, poses that are not rigid, regions that are
    /// not valid. A covariance that is not usable counts as large. An edge from a keyframe that never arrived
    /// becomes one from the newest of the same odom frame, by odom_from_camera of both, and counts as none
    /// where there is no such.
    const KeyframeTrajectory& add(const Keyframe& keyframe);

    /// add() in steps, for a process that must not wait: insert() does all but optimise, and due() says
    /// whether to. Keyframes may be inserted between prepare() and apply(), one optimisation at a time: they
    /// follow the ones they hang on. What apply() makes of a graph of which a part was moved meanwhile (the
    /// first tie to it was found) is nothing; due() then asks again.
    const KeyframeTrajectory& insert(const Keyframe& keyframe);
    bool due() const;
    GraphOptimisation prepare();
    const KeyframeTrajectory& apply(const GraphOptimisation& optimisation);

    /// Takes from the map which regions show one surface: each is one landmark from now on, and what they
    /// say against the poses counts when the next keyframe comes, or at the end. Returns whether that was
    /// news. Not between prepare() and apply().
    bool adopt(const Surfaces& surfaces);

    /// Optimises once more, with all that is known; for the end of a run.
    const KeyframeTrajectory& finish();

    /// What all keyframes say of their sensor's depth; `so_far` corrected it before it came here. The graph
    /// stays as it is.
    BentDepth bent_depth(const CameraInfo& camera, const DepthCorrection& so_far,
                         const Flatness& flatness = {}) const;

    /// True for the ids that may come next: greater than the last one's by at most 10,000. When the second
    /// keyframe's id is not, nobody knows which of both is a stray; add() then starts anew with it.
    bool expects(int id) const;

    const KeyframeTrajectory& trajectory() const;
    /// Those that were accepted, in the order they were found: of more than 512, the newest.
    const std::vector<LoopClosure>& loop_closures() const;
    const GraphCounts& counts() const;
    /// Bytes that are kept, roughly.
    std::size_t memory_bytes() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace planemap::graph
