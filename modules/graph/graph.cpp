// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <string>

#include "core/validation.hpp"
#include "graph/landmarks.hpp"
#include "graph/optimisation.hpp"
#include "graph/place_index.hpp"
#include "graph/surroundings.hpp"
#include "graph/ties.hpp"
#include "graph/verification.hpp"
#include "graph/view.hpp"

namespace planemap {

namespace {

constexpr double kMaxReach = 1e6;   // metres: further away is not a pose but a mistake
constexpr int kMostMissed = 10000;  // keyframes between two that arrive

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

using graph::Drift;
using graph::Tie;

struct Node {
    int id = -1;
    std::int64_t utime = 0;
    Pose odom_from_camera = Pose::Identity();
    graph::View view;
    int place = -1;          ///< number in the index
    std::vector<int> alike;  ///< ids of newer ones of the same place that look like it
};

/// A tie as seen from one of its nodes.
struct Link {
    int other = -1;
    Drift drift;
    bool is_step = false;
    int loop = -1;  ///< index of the loop closure; -1: none
};

/// What became of a keyframe that went.
struct Successor {
    int keeper_id = -1;
    Pose keeper_from_gone = Pose::Identity();
    Drift drift;
};

bool is_pose(const Pose& pose) {
    return is_valid(pose) && pose.translation().cwiseAbs().maxCoeff() < kMaxReach;
}

/// A keyframe's id is the next one, or a few later; a later one than that is a mistake, or another
/// odometry's.
bool follows(int id, int last_id) {
    return id > last_id && id - last_id <= kMostMissed;
}

void check(const Keyframe& keyframe, std::optional<int> last_id) {
    FieldErrors errors("keyframe");
    if (last_id) {
        errors.require(
            follows(keyframe.id, *last_id), "id", keyframe.id,
            "greater than " + std::to_string(*last_id) + " by at most " + std::to_string(kMostMissed));
    }
    errors.require(keyframe.id >= 0, "id", keyframe.id, "at least 0");
    errors.require(keyframe.previous_id >= -1 && keyframe.previous_id < std::max(keyframe.id, 0),
                   "previous_id", keyframe.previous_id, "-1 or an earlier keyframe's id");
    errors.require(is_pose(keyframe.odom_from_camera), "odom_from_camera", "not a rigid transform",
                   "a rigid transform");
    errors.require(keyframe.previous_id < 0 || is_pose(keyframe.previous_from_camera), "previous_from_camera",
                   "not a rigid transform", "a rigid transform");
    const auto regions = static_cast<int>(keyframe.regions.size());
    for (std::size_t i = 0; i < keyframe.features.size() && !errors.any(); ++i) {
        const Feature& feature = keyframe.features[i];
        const std::string name = "features[" + std::to_string(i) + "]";
        errors.require(feature.point.allFinite(), name + ".point", "not finite", "finite");
        errors.require(feature.pixel.allFinite(), name + ".pixel", "not finite", "finite");
        errors.require(feature.region >= -1 && feature.region < regions, name + ".region", feature.region,
                       "-1 or an index into regions");
    }
    check_depth(keyframe.noise, keyframe.depth_min_m, keyframe.depth_max_m, errors);
    for (std::size_t i = 0; i < keyframe.regions.size() && !errors.any(); ++i) {
        errors.require(is_valid(keyframe.regions[i]), "regions[" + std::to_string(i) + "]", "not valid",
                       "finite, with a unit normal and at least three points");
    }
    errors.throw_if_any();
}

graph::VerificationOptions verification_options(const GraphOptions& options) {
    graph::VerificationOptions out;
    out.matching = {options.max_descriptor_distance, options.matching_ratio};
    out.bearing_sigma = options.bearing_sigma;
    out.min_inliers = options.min_inliers;
    out.min_inlier_ratio = options.min_inlier_ratio;
    out.min_visible_ratio = options.min_visible_ratio;
    out.max_contradiction = options.max_contradiction;
    return out;
}

graph::LandmarkOptions landmark_options(const GraphOptions& options) {
    graph::LandmarkOptions out;
    out.min_extent_m = options.landmark_extent_m;
    out.max_angle_deg = options.landmark_angle_deg;
    out.max_distance_m = options.landmark_distance_m;
    out.max_gap_m = options.landmark_gap_m;
    out.sigma_m = options.landmark_sigma_m;
    return out;
}

/// Largest standard deviation of a covariance's translation and rotation; 0 where it is not usable.
Drift worst_sigmas(const Matrix6d& covariance) {
    if (!covariance.allFinite()) return {0, 0};
    const auto worst = [](const Eigen::Matrix3d& block) {
        return std::sqrt(std::max(0.0, block.diagonal().maxCoeff()));
    };
    return {worst(covariance.topLeftCorner<3, 3>()), worst(covariance.bottomRightCorner<3, 3>())};
}

/// Sets of nodes that are tied to each other.
class Components {
  public:
    explicit Components(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int node) {
        while (parent_[at(node)] != node) node = parent_[at(node)] = parent_[at(parent_[at(node)])];
        return node;
    }
    /// False when they were one already.
    bool join(int a, int b) {
        const int root_a = find(a), root_b = find(b);
        parent_[at(std::max(root_a, root_b))] = std::min(root_a, root_b);
        return root_a != root_b;
    }

  private:
    std::vector<int> parent_;
};

}  // namespace

struct GraphOptimisation::Work {
    std::vector<graph::PoseEdge> edges;
    std::vector<graph::PoseEdge> trusting_edges;  ///< to start with; none: the poses are near enough
    std::vector<graph::PoseEdge> new_loops;       ///< what they trust
    std::vector<Pose> poses;                      ///< world_from_camera of each node
    std::vector<graph::Landmark> landmarks;
    std::vector<graph::Sighting> sightings;
    double kernel_width = 0;
    int max_iterations = 0;
    std::size_t loops = 0;  ///< how many there were
    int parts_moved = 0;    ///< how often a part of the graph had been moved as a whole

    /// A loop closure far from the present poses is first trusted fully, so that it can pull against the
    /// kernel; when the rest contradicts it, the kernel lets go of it.
    void run() {
        const graph::OptimisationOptions options{kernel_width, max_iterations};
        if (!trusting_edges.empty()) {
            graph::optimise(poses, trusting_edges, 0, options, &landmarks, sightings);
            const bool fit = std::all_of(new_loops.begin(), new_loops.end(), [&](const auto& edge) {
                return graph::edge_error(edge, poses[at(edge.from)], poses[at(edge.to)]).norm() <
                       kernel_width;
            });
            if (fit) return;
        }
        graph::optimise(poses, edges, 0, options, &landmarks, sightings);
    }
};

class PoseGraph::Impl {
  public:
    explicit Impl(GraphOptions options)
        : options_(std::move(options)), landmarks_(landmark_options(options_)) {
        options_.validate();
        closures_.reserve(kClosuresTold + 1);
    }

    const KeyframeTrajectory& add(const Keyframe& keyframe) {
        extend(keyframe);
        if (due_) optimise();
        thin();
        publish_poses();
        return trajectory_;
    }

    const KeyframeTrajectory& insert(const Keyframe& keyframe) {
        extend(keyframe);
        thin();
        publish_poses();
        return trajectory_;
    }

    bool expects(int id) const { return nodes_.empty() || follows(id, nodes_.back().id); }

    bool due() const { return due_; }

    std::unique_ptr<GraphOptimisation::Work> prepare();
    const KeyframeTrajectory& apply(const GraphOptimisation::Work& work) {
        take(work);
        thin();
        publish_poses();
        return trajectory_;
    }

    const KeyframeTrajectory& finish() {
        if (newest() > 0) {
            optimise();
            publish_poses();
        }
        return trajectory_;
    }

    const KeyframeTrajectory& trajectory() const { return trajectory_; }
    const std::vector<LoopClosure>& loop_closures() const { return closures_; }
    const GraphCounts& counts() const { return counts_; }
    std::size_t memory_bytes() const;

  private:
    int newest() const { return static_cast<int>(nodes_.size()) - 1; }

    /// Notes which landmarks the newest keyframe sees; 0 while it is not tied to the first keyframe, since
    /// its pose says nothing then.
    double sight(const Keyframe& keyframe) {
        Components parts = components();
        if (parts.find(newest()) != parts.find(0)) return 0;
        return landmarks_.add(newest(), keyframe.regions, poses_.back(), keyframe.noise);
    }

    void extend(const Keyframe& keyframe) {
        const bool is_first_a_stray = nodes_.size() == 1 && !expects(keyframe.id);
        check(keyframe, nodes_.empty() || is_first_a_stray ? std::nullopt : std::optional(nodes_.back().id));
        if (is_first_a_stray) *this = Impl(options_);
        append(keyframe);
        close_loops();
        disagreement_ = std::max(disagreement_, sight(keyframe));
        ++since_optimised_;
        due_ = due_ || is_due();
    }

    /// At once when a loop closure is far from the present poses. What pulls less waits the longer the larger
    /// the graph is, so that the cost a keyframe stays flat; finish() makes up for what waits.
    bool is_due() const {
        constexpr std::size_t kNodesAKeyframe = 50;
        if (options_.optimise_every > 0 && nodes_.size() % at(options_.optimise_every) == 0) return true;
        if (worst_new_loop() > kFar * options_.kernel_width) return true;
        const bool any_new = std::any_of(loops_.begin(), loops_.end(), [](auto& t) { return !t.is_known; });
        return (any_new || disagreement_ > options_.landmark_trigger) &&
               since_optimised_ > nodes_.size() / kNodesAKeyframe;
    }

    /// Largest whitened error of the loop closures that no optimisation knows yet.
    double worst_new_loop() const {
        double worst = 0;
        for (const Tie& tie : loops_) {
            if (!tie.is_known) worst = std::max(worst, whitened_error(tie.edge));
        }
        return worst;
    }

    double whitened_error(const graph::PoseEdge& edge) const {
        return graph::edge_error(edge, poses_[at(edge.from)], poses_[at(edge.to)]).norm();
    }

    /// Adds the node, ties it to the previous one and places it.
    void append(const Keyframe& keyframe) {
        nodes_.push_back({keyframe.id,
                          keyframe.utime,
                          keyframe.odom_from_camera,
                          graph::make_view(keyframe, options_.max_features),
                          -1,
                          {}});
        Node& added = nodes_.back();
        counts_.features_left_out += keyframe.features.size() - added.view.points.size();
        added.place = index_.add(added.view.descriptors);
        links_.emplace_back();
        const int node = newest();
        hangs_on_.push_back(node - 1);
        const int previous = node_of(keyframe.previous_id);
        const auto successor = gone_.find(keyframe.previous_id);
        if (previous >= 0) {
            add_odometry(previous, node, keyframe, keyframe.previous_from_camera, {0, 0});
        } else if (successor != gone_.end()) {
            const Successor& s = successor->second;
            add_odometry(node_of(s.keeper_id), node, keyframe,
                         s.keeper_from_gone * keyframe.previous_from_camera, s.drift);
        } else if (node == 0) {
            poses_.push_back(keyframe.odom_from_camera);
        } else {
            add_gap(node, keyframe);
        }
        trajectory_.keyframes.push_back({keyframe.id, keyframe.utime, Pose::Identity()});
    }

    /// The node of a keyframe, -1 if there is none.
    int node_of(int id) const {
        const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), id,
                                            [](const Node& node, int wanted) { return node.id < wanted; });
        return found != nodes_.end() && found->id == id ? static_cast<int>(found - nodes_.begin()) : -1;
    }

    /// `step` leads from the node; `detour` is how far it may be off besides, when the keyframe that odometry
    /// named has gone.
    void add_odometry(int from, int to, const Keyframe& keyframe, const Pose& step, const Drift& detour) {
        const double drift = options_.drift_per_metre * step.translation().norm() +
                             options_.drift_per_radian * rotation_angle(step);
        Tie tie;
        tie.edge = {from, to, step,
                    graph::sqrt_information(keyframe.covariance, options_.odometry_sigma_m + detour.metres,
                                            options_.odometry_sigma_rad + detour.radians),
                    false};
        tie.drift = Drift{drift, drift} + worst_sigmas(keyframe.covariance) + detour;
        tie.is_step = true;
        odometry_.push_back(tie);
        link(tie);
        hangs_on_.back() = from;
        poses_.push_back(orthonormalised(poses_[at(from)] * step));
    }

    /// After a loss: placed by odom_from_camera; how far the camera went meanwhile is bounded by its speed.
    void add_gap(int node, const Keyframe& keyframe) {
        const Node& last = nodes_[at(node - 1)];
        const double seconds = std::clamp(
            static_cast<double>(keyframe.utime) * 1e-6 - static_cast<double>(last.utime) * 1e-6, 0.0, 3600.0);
        const double reach = options_.max_lost_speed * seconds;
        const Matrix6d nothing_known = Matrix6d::Zero();
        Tie gap;
        gap.edge = {node - 1, node,
                    last.odom_from_camera.inverse(Eigen::Isometry) * keyframe.odom_from_camera,
                    graph::sqrt_information(nothing_known, 1.0 + reach, std::numbers::pi), false};
        gap.drift = {reach, std::numbers::pi};
        gaps_.push_back(gap);
        link(gap);
        poses_.push_back(orthonormalised(world_from_odom() * keyframe.odom_from_camera));
    }

    Pose world_from_odom() const { return trajectory_.world_from_odom; }

    void link(const Tie& tie, int loop = -1) {
        links_[at(tie.edge.from)].push_back({tie.edge.to, tie.drift, tie.is_step, loop});
        links_[at(tie.edge.to)].push_back({tie.edge.from, tie.drift, tie.is_step, loop});
    }

    /// All links anew, after nodes went.
    void relink() {
        links_.assign(nodes_.size(), {});
        for (const Tie& tie : odometry_) link(tie);
        for (const Tie& tie : gaps_) link(tie);
        for (std::size_t i = 0; i < loops_.size(); ++i) link(loops_[i], static_cast<int>(i));
    }

    /// Whether the poses follow a link. Not a loop closure that the last optimisation did not know, or let go
    /// of.
    bool holds(const Link& link) const { return link.loop < 0 || holds(loops_[at(link.loop)]); }
    static bool holds(const Tie& loop) { return loop.is_applied && loop.weight >= graph::kDistrusted; }

    /// Least drift from a node to each other one (Dijkstra).
    std::vector<Drift> drifts_from(int source) const {
        std::vector<Drift> drifts(nodes_.size());
        drifts[at(source)] = {0, 0};
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        open.emplace(0.0, source);
        while (!open.empty()) {
            const auto [size, node] = open.top();
            open.pop();
            if (size > drifts[at(node)].size()) continue;
            for (const Link& link : links_[at(node)]) {
                if (!holds(link)) continue;
                const Drift drift = drifts[at(node)] + link.drift;
                if (drift.size() >= drifts[at(link.other)].size()) continue;
                drifts[at(link.other)] = drift;
                open.emplace(drift.size(), link.other);
            }
        }
        return drifts;
    }

    /// Marks the nodes within min_separation steps of odometry from the newest, itself included.
    std::vector<bool> neighbours() const {
        std::vector<bool> near(nodes_.size(), false);
        near.back() = true;
        std::vector<int> ring{newest()};
        for (int step = 1; step < options_.min_separation; ++step) {
            std::vector<int> next;
            for (const int node : ring) {
                for (const Link& link : links_[at(node)]) {
                    if (!link.is_step || near[at(link.other)]) continue;
                    near[at(link.other)] = true;
                    next.push_back(link.other);
                }
            }
            ring = std::move(next);
        }
        return near;
    }

    /// The nodes of the highest scores of at least `least`, none beside another.
    static std::vector<int> peaks(const std::vector<double>& scores, double least, int count) {
        std::vector<int> order;
        for (int i = 0; i < static_cast<int>(scores.size()); ++i) {
            if (scores[at(i)] >= least && scores[at(i)] > 0) order.push_back(i);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return scores[at(a)] > scores[at(b)]; });
        std::vector<int> chosen;
        for (const int node : order) {
            if (static_cast<int>(chosen.size()) >= count) break;
            const bool beside = std::any_of(chosen.begin(), chosen.end(),
                                            [&](int other) { return std::abs(other - node) <= 2; });
            if (!beside) chosen.push_back(node);
        }
        return chosen;
    }

    std::vector<double> appearance_scores(const std::vector<bool>& near) const {
        const std::vector<double> by_place = index_.scores(nodes_.back().view.descriptors);
        std::vector<double> scores(nodes_.size(), 0.0);
        for (std::size_t i = 0; i < scores.size(); ++i) {
            if (!near[i]) scores[i] = by_place[at(nodes_[i].place)];
        }
        return scores;
    }

    /// Share of the newest view that each node should see too; 0 where drift leaves that open.
    std::vector<double> place_scores(const std::vector<bool>& near, const std::vector<Drift>& drifts) const {
        constexpr double kFarthest = 4.0;  // metres between two cameras that see the same from alike
        std::vector<double> scores(nodes_.size(), 0.0);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (near[i] || drifts[i].metres > options_.max_place_drift_m) continue;
            if ((poses_[i].translation() - poses_.back().translation()).norm() > kFarthest) continue;
            const Pose node_from_newest = poses_[i].inverse(Eigen::Isometry) * poses_.back();
            if (node_from_newest.linear()(2, 2) < 0.5) continue;  // optical axes more than 60 degrees apart
            scores[i] = std::min(graph::overlap(nodes_[i].view, nodes_.back().view, node_from_newest),
                                 graph::overlap(nodes_.back().view, nodes_[i].view,
                                                node_from_newest.inverse(Eigen::Isometry)));
        }
        return scores;
    }

    std::vector<int> candidates(const std::vector<Drift>& drifts) const {
        const std::vector<bool> near = neighbours();
        std::vector<int> found =
            peaks(appearance_scores(near), options_.min_appearance, options_.appearance_candidates);
        for (const int node :
             peaks(place_scores(near, drifts), options_.min_overlap, options_.place_candidates)) {
            if (std::find(found.begin(), found.end(), node) == found.end()) found.push_back(node);
        }
        return found;
    }

    bool fits_odometry(int node, const Drift& drift, const Pose& node_from_newest) const {
        const Pose expected = poses_[at(node)].inverse(Eigen::Isometry) * poses_.back();
        return (expected.translation() - node_from_newest.translation()).norm() <=
                   options_.drift_base_m + drift.metres &&
               rotation_angle(expected.inverse(Eigen::Isometry) * node_from_newest) <=
                   options_.drift_base_rad + drift.radians;
    }

    /// Whether what was seen about the node can be what was seen about the newest one, if these two are where
    /// the closure says. Asked only of a closure that moves the newest so far that a false one would matter;
    /// the farther it moves, the wider drift lets us look around.
    bool fits_surroundings(int node, const std::vector<Drift>& of_newest, const Pose& node_from_newest,
                           const graph::VerificationOptions& options) const {
        const Pose expected = poses_[at(node)].inverse(Eigen::Isometry) * poses_.back();
        const double jump = (expected.translation() - node_from_newest.translation()).norm() +
                            rotation_angle(expected.inverse(Eigen::Isometry) * node_from_newest);
        if (jump < options_.surroundings_from_m) return true;
        const double reach = std::min(1.0, jump / 3);
        const std::vector<Drift> of_node = drifts_from(node);
        const Pose move = poses_[at(node)] * node_from_newest * poses_.back().inverse(Eigen::Isometry);
        // Where odometry may have gone astray all the way in between, a node belongs to the nearer end only.
        const bool apart = 2 * of_newest[at(node)].metres > jump;
        std::vector<graph::PlacedView> older, newer;
        for (int i = 0; i < newest(); ++i) {
            if (i == node) continue;
            const double to_newest = of_newest[at(i)].metres, to_node = of_node[at(i)].metres;
            if (to_newest < reach && (!apart || to_newest < to_node))
                newer.push_back({&nodes_[at(i)].view, move * poses_[at(i)], to_newest});
            if (to_node < reach && (!apart || to_newest >= to_node))
                older.push_back({&nodes_[at(i)].view, poses_[at(i)], to_node});
        }
        return graph::compare_surroundings(older, newer, options).fit();
    }

    /// Joins the newest keyframe to earlier ones that saw the same.
    void close_loops() {
        if (newest() == 0 || options_.max_closures == 0) return;
        const std::vector<Drift> drifts = drifts_from(newest());
        const graph::VerificationOptions options = verification_options(options_);
        int closed = 0;
        for (const int node : candidates(drifts)) {
            if (closed == options_.max_closures) break;
            const auto seed = static_cast<std::uint64_t>(node) << 32 | static_cast<std::uint64_t>(newest());
            const graph::Verification found =
                graph::verify(nodes_[at(node)].view, nodes_.back().view, options, seed);
            if (found.verdict != graph::Verdict::kAccepted) continue;
            if (!fits_odometry(node, drifts[at(node)], found.a_from_b)) continue;
            if (!fits_surroundings(node, drifts, found.a_from_b, options)) continue;
            add_loop(node, found);
            ++closed;
        }
    }

    void add_loop(int node, const graph::Verification& found) {
        carry_component(node, found.a_from_b);
        Tie tie;
        tie.edge = {node, newest(), found.a_from_b,
                    graph::sqrt_information(found.covariance, options_.loop_sigma_m, options_.loop_sigma_rad),
                    true};
        tie.drift = worst_sigmas(found.covariance) + Drift{options_.loop_sigma_m, options_.loop_sigma_rad};
        tie.closure = trajectory_.loop_closures++;
        tie.is_known = tie.is_applied = false;
        loops_.push_back(tie);
        link(tie, static_cast<int>(loops_.size()) - 1);
        closures_.push_back({nodes_[at(node)].id, nodes_.back().id, nodes_[at(node)].utime,
                             nodes_.back().utime, found.a_from_b, found.covariance, found.matches,
                             found.inliers, 1.0});
        if (closures_.size() > kClosuresTold) {
            closures_.erase(closures_.begin(), closures_.begin() + kClosuresTold / 2);
            first_told_ += kClosuresTold / 2;
        }
    }

    Components components() const {
        Components components(nodes_.size());
        for (const auto& tie : odometry_) components.join(tie.edge.from, tie.edge.to);
        for (const auto& tie : loops_) components.join(tie.edge.from, tie.edge.to);
        return components;
    }

    /// When a loop closure is the first tie between two parts of the graph, the part without the first
    /// keyframe is moved as a whole to where the closure says.
    void carry_component(int node, const Pose& node_from_newest) {
        Components parts = components();
        const int part = parts.find(node), newest_part = parts.find(newest());
        if (part == newest_part) return;
        const bool carry_newest = newest_part != parts.find(0);
        const Pose correction = poses_[at(node)] * node_from_newest * poses_.back().inverse(Eigen::Isometry);
        const Pose move = carry_newest ? correction : correction.inverse(Eigen::Isometry);
        const int moving = carry_newest ? newest_part : part;
        ++parts_moved_;
        for (int i = 0; i <= newest(); ++i) {
            if (parts.find(i) == moving) poses_[at(i)] = orthonormalised(move * poses_[at(i)]);
        }
    }

    /// All edges; of the gaps only those across which nothing else ties the parts. To start with, loop
    /// closures that counted as wrong are left out, and new ones are beyond doubt.
    std::vector<graph::PoseEdge> all_edges(bool to_start_with) const {
        std::vector<graph::PoseEdge> edges;
        Components parts(nodes_.size());
        for (const Tie& tie : odometry_) {
            edges.push_back(tie.edge);
            parts.join(tie.edge.from, tie.edge.to);
        }
        for (const Tie& tie : loops_) {
            if (to_start_with && tie.weight < graph::kDistrusted) continue;
            edges.push_back(tie.edge);
            edges.back().robust = !to_start_with || tie.is_known;
            parts.join(tie.edge.from, tie.edge.to);
        }
        for (const Tie& gap : gaps_) {
            if (parts.join(gap.edge.from, gap.edge.to)) edges.push_back(gap.edge);
        }
        return edges;
    }

    void optimise() {
        const std::unique_ptr<GraphOptimisation::Work> work = prepare();
        work->run();
        take(*work);
    }

    /// Takes the poses and landmarks that an optimisation found; later ones follow those they hang on.
    void take(const GraphOptimisation::Work& work) {
        is_optimising_ = false;
        if (work.parts_moved != parts_moved_) {
            due_ = true;
            return;
        }
        std::vector<Pose> moves;  // of the world, about each node
        for (std::size_t i = 0; i < poses_.size(); ++i) {
            const Pose before = poses_[i];
            poses_[i] =
                i < work.poses.size() ? work.poses[i] : orthonormalised(moves[at(hangs_on_[i])] * poses_[i]);
            moves.push_back(poses_[i] * before.inverse(Eigen::Isometry));
        }
        landmarks_.follow(work.landmarks, moves);
        landmarks_.merge();
        for (std::size_t i = 0; i < loops_.size(); ++i) {
            Tie& tie = loops_[i];
            tie.is_applied = tie.is_applied || i < work.loops;
            const double error = whitened_error(tie.edge);
            tie.weight = 1 / (1 + error * error / (options_.kernel_width * options_.kernel_width));
            if (tie.closure >= first_told_)
                closures_[static_cast<std::size_t>(tie.closure - first_told_)].weight = tie.weight;
        }
    }

    void thin();
    void thin_about(int node);
    std::vector<int> place_of(int node) const;
    bool is_alike(int a, int b) const;
    bool may_go(int node) const;
    bool let_go(int node);
    const Tie* way_to_keeper(int node) const;

    void publish_poses() {
        const bool moved = std::any_of(
            revision_poses_.begin(), revision_poses_.end(), [&, i = 0](const Pose& before) mutable {
                const Pose change = before.inverse(Eigen::Isometry) * poses_[at(i++)];
                return change.translation().norm() > options_.revision_m ||
                       rotation_angle(change) > options_.revision_rad;
            });
        if (moved) {
            ++trajectory_.revision;
            revision_poses_ = poses_;
        } else if (revision_poses_.size() < poses_.size()) {
            revision_poses_.push_back(poses_.back());
        }
        trajectory_.utime = nodes_.back().utime;
        trajectory_.world_from_odom =
            orthonormalised(poses_.back() * nodes_.back().odom_from_camera.inverse(Eigen::Isometry));
        for (std::size_t i = 0; i < poses_.size(); ++i)
            trajectory_.keyframes[i].world_from_camera = poses_[i];
    }

    static constexpr double kFar = 2;  // kernel widths: where a loop closure can no longer pull
    static constexpr std::size_t kClosuresTold = 512;  // by loop_closures()
    static constexpr std::size_t kGoneKnown = 512;     // keyframes that went and may yet be named
    static constexpr int kRecent = 24;                 // newest keyframes, which all stay

    GraphOptions options_;
    graph::Landmarks landmarks_;
    double disagreement_ = 0;          ///< of planes since the last optimisation, standard deviations
    std::size_t since_optimised_ = 0;  ///< keyframes since the last optimisation
    bool due_ = false;                 ///< an optimisation
    bool is_optimising_ = false;       ///< between prepare() and apply(): nodes keep their numbers
    int parts_moved_ = 0;              ///< how often a part was moved as a whole
    std::vector<Node> nodes_;          ///< ascending id
    std::vector<Pose> poses_;          ///< world_from_camera of each node
    std::vector<int> hangs_on_;        ///< node that each was placed by; -1 for the first
    std::vector<std::vector<Link>> links_;
    std::vector<Tie> odometry_, loops_, gaps_;
    std::vector<LoopClosure> closures_;  ///< the newest that were accepted
    std::int64_t first_told_ = 0;        ///< number of the first of them
    std::map<int, Successor> gone_;      ///< by the id of a keyframe that went, the newest of them
    int thinned_up_to_ = -1;             ///< id of the newest keyframe about which it was thinned out
    GraphCounts counts_;
    graph::PlaceIndex index_;
    std::vector<Pose> revision_poses_;  ///< of the nodes when they last made a revision
    KeyframeTrajectory trajectory_;
};

std::unique_ptr<GraphOptimisation::Work> PoseGraph::Impl::prepare() {
    auto work = std::make_unique<GraphOptimisation::Work>();
    work->edges = all_edges(false);
    if (worst_new_loop() > kFar * options_.kernel_width) {
        work->trusting_edges = all_edges(true);
        for (const Tie& tie : loops_) {
            if (!tie.is_known) work->new_loops.push_back(tie.edge);
        }
    }
    for (Tie& tie : loops_) tie.is_known = true;
    work->poses = poses_;
    work->landmarks = landmarks_.landmarks();
    work->sightings = landmarks_.shared();
    work->kernel_width = options_.kernel_width;
    work->max_iterations = options_.max_iterations;
    work->loops = loops_.size();
    work->parts_moved = parts_moved_;
    is_optimising_ = true;
    since_optimised_ = 0;
    disagreement_ = 0;
    due_ = false;
    return work;
}

/// Where keyframes of one place pile up, the older ones go: after each keyframe that is no longer among the
/// newest, which odometry may still name.
void PoseGraph::Impl::thin() {
    if (options_.max_alike == 0) return;
    for (int node = 0; node <= newest() - kRecent && !is_optimising_; ++node) {
        const int id = nodes_[at(node)].id;
        if (id <= thinned_up_to_) continue;
        thinned_up_to_ = id;
        thin_about(node);
        node = node_of(id);  // the number it has now
    }
}

/// Of the keyframes about where this one stood, one that looks like max_alike newer ones is redundant, and
/// there are at most max_place in all. The older goes, so that the graph knows the place as it is now.
void PoseGraph::Impl::thin_about(int node) {
    std::vector<int> place = place_of(node);  // newest first, this one included
    std::vector<int> ids;                     // of those that go
    for (std::size_t i = 1; i < place.size(); ++i) {
        Node& older = nodes_[at(place[i])];
        if (!is_alike(place[i], node)) continue;
        std::erase_if(older.alike, [&](int id) { return node_of(id) < 0; });
        older.alike.push_back(nodes_[at(node)].id);
        if (older.alike.size() >= at(options_.max_alike)) ids.push_back(older.id);
    }
    for (std::size_t i = place.size(); i-- > 1 && place.size() - ids.size() > at(options_.max_place);) {
        const int id = nodes_[at(place[i])].id;
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    }
    bool any = false;
    for (const int id : ids) any = let_go(node_of(id)) || any;
    if (any) relink();
}

/// The keyframes that stood where this older one did, itself included, the newest first. Only where the poses
/// say so for certain.
std::vector<int> PoseGraph::Impl::place_of(int node) const {
    const double reach = options_.place_share * graph::mean_depth(nodes_[at(node)].view);
    const std::vector<Drift> drifts = drifts_from(node);
    std::vector<int> place;
    for (int i = node; i >= 0; --i) {
        const Pose apart = poses_[at(i)].inverse(Eigen::Isometry) * poses_[at(node)];
        const double metres = std::max(apart.translation().norm(), drifts[at(i)].metres);
        const double radians = std::max(rotation_angle(apart), drifts[at(i)].radians);
        if (i == node || (metres < reach && radians < options_.place_rad)) place.push_back(i);
    }
    return place;
}

/// Whether two keyframes of one place show the same: the same points or, where there are none, the same
/// planes; and neither saw through what the other saw.
bool PoseGraph::Impl::is_alike(int a, int b) const {
    constexpr int kFewPoints = 20;
    constexpr double kSlack_m = 0.02;
    const graph::View &view_a = nodes_[at(a)].view, &view_b = nodes_[at(b)].view;
    const Pose a_from_b = poses_[at(a)].inverse(Eigen::Isometry) * poses_[at(b)];
    const graph::VerificationOptions options = verification_options(options_);
    const graph::PointAgreement points = graph::compare_points(view_a, view_b, a_from_b, options, kSlack_m);
    const bool is_bare = view_a.points.size() < kFewPoints && view_b.points.size() < kFewPoints;
    if (!is_bare && points.agree < std::max<double>(kFewPoints, options_.min_alike_ratio * points.visible))
        return false;
    const graph::PlaneAgreement planes = graph::compare_planes(view_a, view_b, a_from_b, kSlack_m);
    if (is_bare && planes.agree == 0) return false;
    return planes.contradict <= options_.max_contradiction * (planes.agree + planes.contradict);
}

/// Not the first keyframe, which is the world's; nor one with a loop closure that the poses do not follow
/// yet.
bool PoseGraph::Impl::may_go(int node) const {
    return node > 0 && std::none_of(loops_.begin(), loops_.end(),
                                    [&](const Tie& tie) { return tie.touches(node) && !tie.is_applied; });
}

/// The tie to the nearest of the nodes that are tied to this one beyond doubt.
const Tie* PoseGraph::Impl::way_to_keeper(int node) const {
    constexpr double kTrusted = 0.5;  // weight of a loop closure
    const Tie* best = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto* ties : {&odometry_, &loops_}) {
        for (const Tie& tie : *ties) {
            if (!tie.touches(node) || tie.weight < kTrusted) continue;
            const Pose apart = poses_[at(tie.other(node))].inverse(Eigen::Isometry) * poses_[at(node)];
            const double distance = apart.translation().norm() + rotation_angle(apart);
            if (distance >= nearest) continue;
            nearest = distance;
            best = &tie;
        }
    }
    return best;
}

/// Removes a node and hands what it knows to the one that keeps it; false where there is none.
bool PoseGraph::Impl::let_go(int node) {
    const Tie* found = may_go(node) ? way_to_keeper(node) : nullptr;
    if (found == nullptr) return false;
    const Tie to_keeper = *found;
    const int keeper = to_keeper.other(node), id = nodes_[at(node)].id;
    const Successor successor{nodes_[at(keeper)].id,
                              poses_[at(keeper)].inverse(Eigen::Isometry) * poses_[at(node)],
                              to_keeper.drift};
    for (auto& [gone, s] : gone_) {
        if (s.keeper_id != id) continue;
        s = {successor.keeper_id, successor.keeper_from_gone * s.keeper_from_gone, s.drift + successor.drift};
    }
    gone_[id] = successor;
    if (gone_.size() > kGoneKnown) gone_.erase(gone_.begin());

    for (auto* ties : {&odometry_, &loops_, &gaps_}) graph::hand_over(*ties, to_keeper, node, poses_);
    landmarks_.hand_over(node, keeper, successor.keeper_from_gone);
    index_.remove(nodes_[at(node)].place, nodes_[at(node)].view.descriptors);
    for (int& base : hangs_on_) {
        if (base == node) base = keeper;
        if (base > node) --base;
    }
    const auto erase = [&](auto& values) {
        if (at(node) < values.size()) values.erase(values.begin() + node);
    };
    erase(hangs_on_);
    erase(nodes_);
    erase(poses_);
    erase(revision_poses_);
    erase(trajectory_.keyframes);
    ++counts_.replaced;
    return true;
}

std::size_t PoseGraph::Impl::memory_bytes() const {
    std::size_t bytes = index_.memory_bytes() + closures_.capacity() * sizeof(LoopClosure) +
                        gone_.size() * sizeof(std::pair<int, Successor>) + landmarks_.memory_bytes();
    for (const auto* ties : {&odometry_, &loops_, &gaps_}) bytes += ties->capacity() * sizeof(Tie);
    for (const Node& node : nodes_) bytes += sizeof(Node) + graph::memory_bytes(node.view);
    for (const auto& links : links_) bytes += sizeof(links) + links.capacity() * sizeof(Link);
    return bytes;
}

GraphOptimisation::GraphOptimisation(std::unique_ptr<Work> work) : work_(std::move(work)) {}
GraphOptimisation::~GraphOptimisation() = default;
GraphOptimisation::GraphOptimisation(GraphOptimisation&&) noexcept = default;
GraphOptimisation& GraphOptimisation::operator=(GraphOptimisation&&) noexcept = default;

void GraphOptimisation::run() {
    work_->run();
}

PoseGraph::PoseGraph(GraphOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
PoseGraph::~PoseGraph() = default;
PoseGraph::PoseGraph(PoseGraph&&) noexcept = default;
PoseGraph& PoseGraph::operator=(PoseGraph&&) noexcept = default;

const KeyframeTrajectory& PoseGraph::add(const Keyframe& keyframe) {
    return impl_->add(keyframe);
}

const KeyframeTrajectory& PoseGraph::insert(const Keyframe& keyframe) {
    return impl_->insert(keyframe);
}

bool PoseGraph::due() const {
    return impl_->due();
}

GraphOptimisation PoseGraph::prepare() {
    return GraphOptimisation(impl_->prepare());
}

const KeyframeTrajectory& PoseGraph::apply(const GraphOptimisation& optimisation) {
    return impl_->apply(optimisation.work());
}

const KeyframeTrajectory& PoseGraph::finish() {
    return impl_->finish();
}

const KeyframeTrajectory& PoseGraph::trajectory() const {
    return impl_->trajectory();
}

const std::vector<LoopClosure>& PoseGraph::loop_closures() const {
    return impl_->loop_closures();
}

bool PoseGraph::expects(int id) const {
    return impl_->expects(id);
}

const GraphCounts& PoseGraph::counts() const {
    return impl_->counts();
}

std::size_t PoseGraph::memory_bytes() const {
    return impl_->memory_bytes();
}

}  // namespace planemap
