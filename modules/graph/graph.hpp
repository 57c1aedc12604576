// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/camera.hpp"
#include "core/keyframe.hpp"
#include "core/option_list.hpp"

namespace planemap {

/// Options of PoseGraph; options_of() says what each is.
struct GraphOptions {
    int max_features = 600;

    int min_separation = 8;
    int appearance_candidates = 3;
    int place_candidates = 3;
    int max_closures = 2;
    double max_place_drift_m = 1.0;
    double matching_ratio = 0.85;
    int min_inliers = 25;
    double min_inlier_ratio = 0.35;
    double surroundings_from_m = 0.3;

    int max_alike = 2;
    int max_place = 8;

    double drift_per_metre = 0.05;
    double drift_per_radian = 0.05;
    double drift_base_m = 0.2;
    double drift_base_rad = 0.2;
    double max_lost_speed = 2.0;

    double odometry_sigma_m = 0.005;
    double odometry_sigma_rad = 0.005;
    double loop_sigma_m = 0.010;
    double loop_sigma_rad = 0.005;
    double landmark_angle_deg = 8;
    double landmark_distance_m = 0.06;
    double landmark_gap_m = 0.5;
    double landmark_sigma_m = 0.01;
    int optimise_every = 0;

    // Fixed: nobody can tell how to set these without reading the code.
    static constexpr double min_appearance = 0.02;      ///< share of the new keyframe's rare features that a
                                                        ///< candidate for a loop closure has too
    static constexpr double min_overlap = 0.3;          ///< share of points in view, for a candidate by place
    static constexpr int max_descriptor_distance = 64;  ///< bits in which two descriptors of one point differ
    static constexpr double bearing_sigma = 0.003;     ///< of the features' points across their rays, radians
    static constexpr double min_visible_ratio = 0.12;  ///< inliers, of the points that both views should see
    static constexpr double max_contradiction = 0.25;  ///< share of plane samples that the other view saw
                                                       ///< through
    static constexpr double place_share = 0.08;  ///< keyframes are of one place when they stand nearer than
                                                 ///< this share of the depth that they see,
    static constexpr double place_rad = 0.17;    ///< and are turned by less
    static constexpr double min_alike_ratio = 0.25;  ///< like points, of those that both should see, of views
                                                     ///< that look alike
    static constexpr double landmark_extent_m = 0.25;  ///< smaller regions are no landmarks; standard
                                                       ///< deviation of the shorter side
    static constexpr double landmark_trigger = 2.0;    ///< standard deviations by which a keyframe's planes
                                                       ///< must disagree to optimise
    static constexpr double kernel_width = 3.0;  ///< Cauchy kernel of loop closures, standard deviations
    static constexpr int max_iterations = 30;    ///< of one optimisation
    static constexpr double revision_m = 0.001, revision_rad = 0.0005;  ///< movement of a keyframe that makes
                                                                        ///< a new revision

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(GraphOptions& options);

/// Two keyframes that saw the same place.
struct LoopClosure {
    int from_id = -1, to_id = -1;               ///< from the older to the newer one
    std::int64_t from_utime = 0, to_utime = 0;  ///< Keyframe::utime of both
    Pose from_from_to = Pose::Identity();       ///< newer camera in the older camera's frame
    Matrix6d covariance = Matrix6d::Zero();     ///< translation, rotation; newer camera's frame
    int matches = 0;                            ///< descriptors matched
    int inliers = 0;                            ///< points that agree
    double weight =
        1;  ///< in the last optimisation, 0 to 1: near 0 when the rest of the graph contradicts it
};

/// What a graph did without.
struct GraphCounts {
    std::size_t replaced = 0;           ///< keyframes that went for newer ones of the same place
    std::size_t features_left_out = 0;  ///< features without a point before the camera, or one too many
};

/// One optimisation of a PoseGraph as it was when prepared, with a copy of all that it needs: run() may run
/// on another thread while the graph grows.
class GraphOptimisation {
  public:
    struct Work;

    explicit GraphOptimisation(std::unique_ptr<Work> work);
    ~GraphOptimisation();
    GraphOptimisation(GraphOptimisation&&) noexcept;
    GraphOptimisation& operator=(GraphOptimisation&&) noexcept;

    /// Call it once; then give it back to PoseGraph::apply().
    void run();
    const Work& work() const { return *work_; }

  private:
    std::unique_ptr<Work> work_;
};

/// Keyframes, the edges between them, and the poses that fit all edges best. World is the odom frame of the
/// first keyframe, and the first keyframe never moves. The same keyframes in the same order give the same
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
    /// counts as none: like after a loss, the keyframe is placed by odom_from_camera until a loop closure
    /// ties it to the others.
    const KeyframeTrajectory& add(const Keyframe& keyframe);

    /// add() in steps, for a process that must not wait: insert() does all but optimise, and due() says
    /// whether to. Keyframes may be inserted between prepare() and apply(), one optimisation at a time: they
    /// follow the ones they hang on. What apply() makes of a graph of which a part was moved meanwhile (the
    /// first tie to it was found) is nothing; due() then asks again.
    const KeyframeTrajectory& insert(const Keyframe& keyframe);
    bool due() const;
    GraphOptimisation prepare();
    const KeyframeTrajectory& apply(const GraphOptimisation& optimisation);

    /// Optimises once more, with all that is known; for the end of a run.
    const KeyframeTrajectory& finish();

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

}  // namespace planemap
