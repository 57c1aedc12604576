// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "graph/admission.hpp"
#include "graph/closure_history.hpp"
#include "graph/keyframes.hpp"
#include "graph/landmarks.hpp"
#include "graph/loop_search.hpp"
#include "graph/optimisation_task.hpp"
#include "graph/published_trajectory.hpp"
#include "graph/redundancy.hpp"
#include "graph/schedule.hpp"
#include "graph/successors.hpp"
#include "graph/topology.hpp"

namespace planemap::graph {

namespace {

GraphOptions valid(const GraphOptions& options) {
    options.validate();
    return options;
}

/// Of any two times: as integers their difference may have no room.
double seconds_between(const KeyframeNode& from, const KeyframeNode& to) {
    return static_cast<double>(to.utime) * 1e-6 - static_cast<double>(from.utime) * 1e-6;
}

}  // namespace

/// Leads a keyframe through the parts that own the graph's state, one after the other; what it is and where
/// it stands is theirs.
class PoseGraph::Impl {
  public:
    explicit Impl(const GraphOptions& options) : options_(valid(options)) {}

    void extend(const Keyframe& keyframe);
    void optimise();
    OptimisationTask task() const;
    std::unique_ptr<OptimisationTask> prepare();
    void apply(const OptimisationTask& task);
    bool adopt(const Surfaces& surfaces);
    void thin_out();
    void publish() { trajectory_.update(keyframes_, topology_.parts(), history_.count()); }

    bool expects(int id) const { return keyframes_.empty() || follows(id, keyframes_.back().id); }
    bool is_due() const { return schedule_.is_due(); }
    bool has_edges() const { return keyframes_.size() > 1; }
    const KeyframeTrajectory& trajectory() const { return trajectory_.get(); }
    const std::vector<LoopClosure>& loop_closures() const { return history_.newest(); }
    const GraphCounts& counts() const { return counts_; }
    std::size_t memory_bytes() const;

  private:
    void start_anew();
    void append(const Keyframe& keyframe);
    int same_chain(const Keyframe& keyframe) const;
    void append_by_odometry(int from, KeyframeNode node, const Pose& step, const Matrix6d& covariance,
                            const Drift& detour);
    void append_after_missing(int from, KeyframeNode node, const Matrix6d& covariance);
    void append_after_gap(KeyframeNode node);
    void close_loops();
    void add_loop(int node, const places::Verification& found);
    void carry_part(int node, const Pose& node_from_newest);
    double sight(const Keyframe& keyframe);
    void let_go(int node);

    GraphOptions options_;
    Keyframes keyframes_;
    Successors successors_;
    Topology topology_;
    Landmarks landmarks_{landmark_options(options_)};
    LoopSearch search_{options_};
    ClosureHistory history_;
    Redundancy redundancy_{options_};
    Schedule schedule_{options_};
    PublishedTrajectory trajectory_{options_};
    GraphCounts counts_;
};

void PoseGraph::Impl::extend(const Keyframe& keyframe) {
    const bool is_first_a_stray = keyframes_.size() == 1 && !expects(keyframe.id);
    check(keyframe,
          keyframes_.empty() || is_first_a_stray ? std::nullopt : std::optional(keyframes_.back().id));
    if (is_first_a_stray) start_anew();
    append(keyframe);
    close_loops();
    const double disagreement = sight(keyframe);
    schedule_.keyframe_added({keyframes_.size(), disagreement, topology_.has_new_loops(),
                              topology_.worst_new_loop(keyframes_.poses())});
}

/// Forgets all keyframes; what was counted stays counted.
void PoseGraph::Impl::start_anew() {
    const GraphCounts counts = counts_;
    *this = Impl(options_);
    counts_ = counts;
}

/// Adds the node, places it and ties it to the previous one.
void PoseGraph::Impl::append(const Keyframe& keyframe) {
    KeyframeNode node{keyframe.id, keyframe.utime, keyframe.chain, keyframe.odom_from_camera,
                      places::make_view(keyframe, options_.max_features)};
    counts_.features_left_out += keyframe.features.size() - node.view.points.size();
    search_.add(node.view);
    topology_.add_node();
    const int previous = keyframes_.node_of(keyframe.previous_id);
    const Successor* successor = successors_.of(keyframe.previous_id);
    if (previous >= 0) {
        append_by_odometry(previous, std::move(node), keyframe.previous_from_camera, keyframe.covariance,
                           {0, 0});
    } else if (successor != nullptr) {
        append_by_odometry(keyframes_.node_of(successor->keeper_id), std::move(node),
                           successor->keeper_from_gone * keyframe.previous_from_camera, keyframe.covariance,
                           successor->drift);
    } else if (keyframes_.empty()) {
        keyframes_.add(std::move(node), keyframe.odom_from_camera, -1);
    } else if (const int same = same_chain(keyframe); same >= 0) {
        append_after_missing(same, std::move(node), keyframe.covariance);
    } else {
        append_after_gap(std::move(node));
    }
}

/// The newest node of the odom frame that a keyframe's edge leads from, -1 for none: it begins one, or that
/// is not known. Messages without a chain are of times in which every edge led on in one.
int PoseGraph::Impl::same_chain(const Keyframe& keyframe) const {
    if (keyframe.previous_id < 0) return -1;
    return keyframe.chain < 0 ? keyframes_.newest() : keyframes_.newest_of_chain(keyframe.chain);
}

/// `step` leads from the node; `detour` is how far it may be off besides.
void PoseGraph::Impl::append_by_odometry(int from, KeyframeNode node, const Pose& step,
                                         const Matrix6d& covariance, const Drift& detour) {
    const Matrix6d within = within_reach(covariance, seconds_between(keyframes_[from], node));
    topology_.add_odometry(odometry_tie(options_, from, keyframes_.size(), step, within, detour));
    keyframes_.add(std::move(node), orthonormalised(keyframes_.pose(from) * step), from);
}

/// Keyframes in between never arrived: odometry itself was not lost, so the odom frame is one. `covariance`
/// is of its last step; of those that are missing each counts as much.
void PoseGraph::Impl::append_after_missing(int from, KeyframeNode node, const Matrix6d& covariance) {
    const KeyframeNode& before = keyframes_[from];
    const Pose step =
        orthonormalised(before.odom_from_camera.inverse(Eigen::Isometry) * node.odom_from_camera);
    const double steps = node.id - before.id;
    append_by_odometry(from, std::move(node), step, covariance * steps, {0, 0});
}

/// After a loss a component of its own begins. How far the camera went meanwhile is bounded by its speed;
/// where time went back, by nothing.
void PoseGraph::Impl::append_after_gap(KeyframeNode node) {
    constexpr double kAnyTime_s = 3600;
    const int last = keyframes_.newest();
    const KeyframeNode& before = keyframes_.back();
    const double passed_s = seconds_between(before, node);
    const double seconds = passed_s > 0 ? std::min(passed_s, kAnyTime_s) : kAnyTime_s;
    topology_.add_gap(gap_tie(options_, last, last + 1,
                              before.odom_from_camera.inverse(Eigen::Isometry) * node.odom_from_camera,
                              seconds));
    const Pose pose = orthonormalised(trajectory().world_from_odom * node.odom_from_camera);
    keyframes_.add(std::move(node), pose, last);
}

/// Joins the newest keyframe to earlier ones that saw the same.
void PoseGraph::Impl::close_loops() {
    if (keyframes_.newest() == 0 || options_.max_closures == 0) return;
    const std::vector<Drift> drifts = topology_.drifts_from(keyframes_.newest());
    int closed = 0;
    for (const int node : search_.candidates(keyframes_, topology_, drifts)) {
        if (closed == options_.max_closures) break;
        const auto found = search_.verified(node, keyframes_, topology_, drifts);
        if (!found) continue;
        add_loop(node, *found);
        ++closed;
    }
}

void PoseGraph::Impl::add_loop(int node, const places::Verification& found) {
    carry_part(node, found.a_from_b);
    const KeyframeNode &older = keyframes_[node], &newest = keyframes_.back();
    const std::int64_t number = history_.add({older.id, newest.id, older.utime, newest.utime, found.a_from_b,
                                              found.covariance, found.matches, found.inliers, 1.0});
    topology_.add_loop(
        loop_tie(options_, node, keyframes_.newest(), found.a_from_b, found.covariance, number));
}

/// When a loop closure is the first tie between two components, the younger one is moved as a whole to where
/// the closure says.
void PoseGraph::Impl::carry_part(int node, const Pose& node_from_newest) {
    UnionFind<int> parts = topology_.parts();
    const int newest = keyframes_.newest();
    const int part = parts.find(node), newest_part = parts.find(newest);
    if (part == newest_part) return;
    const bool carry_newest = newest_part > part;
    const Pose correction =
        keyframes_.pose(node) * node_from_newest * keyframes_.pose(newest).inverse(Eigen::Isometry);
    std::vector<bool> moving;
    for (int i = 0; i <= newest; ++i) moving.push_back(parts.find(i) == (carry_newest ? newest_part : part));
    keyframes_.carry(moving, carry_newest ? correction : correction.inverse(Eigen::Isometry));
    schedule_.part_moved();
}

/// Notes which landmarks the newest keyframe sees, and returns how far they disagree (standard deviations).
/// In a component without the first keyframe poses say nothing of which they are: the map does.
double PoseGraph::Impl::sight(const Keyframe& keyframe) {
    UnionFind<int> parts = topology_.parts();
    const int newest = keyframes_.newest();
    return landmarks_.add(newest, keyframe.regions, keyframes_.pose(newest), keyframe.noise,
                          parts.find(newest) == parts.find(0));
}

/// With all that is known, from where the poses are.
OptimisationTask PoseGraph::Impl::task() const {
    OptimisationTask task;
    task.edges = topology_.edges(false);
    task.poses = keyframes_.poses();
    task.landmarks = landmarks_.landmarks();
    task.sightings = landmarks_.shared();
    task.options = {options_.kernel_width, options_.max_iterations};
    task.loops = topology_.loops().size();
    return task;
}

std::unique_ptr<OptimisationTask> PoseGraph::Impl::prepare() {
    auto task = std::make_unique<OptimisationTask>(this->task());
    if (schedule_.is_far(topology_.worst_new_loop(keyframes_.poses()))) {
        task->trusting_edges = topology_.edges(true);
        task->new_loops = topology_.new_loops();
    }
    topology_.mark_known();
    task->started = schedule_.start();
    return task;
}

/// Takes the poses and landmarks that an optimisation found; later ones follow those they hang on.
void PoseGraph::Impl::apply(const OptimisationTask& task) {
    counts_.failed_optimisations += task.failed;
    if (!schedule_.end(task.started)) return;
    const std::vector<Pose> moves = keyframes_.follow(task.poses);
    landmarks_.follow(task.landmarks, moves);
    landmarks_.merge();
    topology_.weigh(task.loops, keyframes_.poses(), options_.kernel_width);
    for (const Tie& loop : topology_.loops()) history_.set_weight(loop.closure, loop.weight);
}

void PoseGraph::Impl::optimise() {
    const std::unique_ptr<OptimisationTask> task = prepare();
    task->run();
    apply(*task);
}

bool PoseGraph::Impl::adopt(const Surfaces& surfaces) {
    std::vector<std::vector<int>> of_nodes(keyframes_.poses().size());
    for (const KeyframeSurfaces& keyframe : surfaces.keyframes) {
        const int node = keyframes_.node_of(keyframe.id);
        if (node >= 0) of_nodes[at(node)] = keyframe.planes;
    }
    const bool is_news = landmarks_.adopt(of_nodes, keyframes_.poses());
    if (is_news) schedule_.landmarks_changed(landmarks_.worst_error(keyframes_.poses()));
    return is_news;
}

/// Where keyframes of one place pile up, the older ones go. Not while an optimisation is at work, which knows
/// nodes by their numbers.
void PoseGraph::Impl::thin_out() {
    while (!schedule_.is_running()) {
        const std::optional<int> node = redundancy_.next(keyframes_);
        if (!node) return;
        for (const int id : redundancy_.about(*node, keyframes_, topology_)) let_go(keyframes_.node_of(id));
    }
}

/// Removes a node and hands what it knows to the nearest one that it is tied to; nothing where there is none.
/// Not the first keyframe of a component, which is the world's; nor one with a loop closure that the poses do
/// not follow yet.
void PoseGraph::Impl::let_go(int node) {
    if (topology_.parts().stands(node) || topology_.has_unapplied_loop(node)) return;
    const std::optional<Tie> to_keeper = topology_.nearest_trusted(node, keyframes_.poses());
    if (!to_keeper) return;
    const int keeper = to_keeper->other(node), id = keyframes_[node].id;
    const Pose keeper_from_gone = keyframes_.between(keeper, node);
    successors_.add(id, {keyframes_[keeper].id, keeper_from_gone, to_keeper->drift});
    topology_.hand_over(*to_keeper, node, keyframes_.poses());
    landmarks_.hand_over(node, keeper, keeper_from_gone);
    search_.remove(node, keyframes_[node].view);
    redundancy_.forget(id);
    trajectory_.remove(node);
    keyframes_.remove(node, keeper);
    ++counts_.replaced;
}

std::size_t PoseGraph::Impl::memory_bytes() const {
    return keyframes_.memory_bytes() + successors_.memory_bytes() + topology_.memory_bytes() +
           landmarks_.memory_bytes() + search_.memory_bytes() + history_.memory_bytes();
}

GraphOptimisation::GraphOptimisation(std::unique_ptr<OptimisationTask> task) : task_(std::move(task)) {}
GraphOptimisation::~GraphOptimisation() = default;
GraphOptimisation::GraphOptimisation(GraphOptimisation&&) noexcept = default;
GraphOptimisation& GraphOptimisation::operator=(GraphOptimisation&&) noexcept = default;

void GraphOptimisation::run() {
    task_->run();
}

PoseGraph::PoseGraph(GraphOptions options) : impl_(std::make_unique<Impl>(options)) {}
PoseGraph::~PoseGraph() = default;
PoseGraph::PoseGraph(PoseGraph&&) noexcept = default;
PoseGraph& PoseGraph::operator=(PoseGraph&&) noexcept = default;

const KeyframeTrajectory& PoseGraph::add(const Keyframe& keyframe) {
    impl_->extend(keyframe);
    if (impl_->is_due()) impl_->optimise();
    impl_->thin_out();
    impl_->publish();
    return impl_->trajectory();
}

const KeyframeTrajectory& PoseGraph::insert(const Keyframe& keyframe) {
    impl_->extend(keyframe);
    impl_->thin_out();
    impl_->publish();
    return impl_->trajectory();
}

bool PoseGraph::due() const {
    return impl_->is_due();
}

GraphOptimisation PoseGraph::prepare() {
    return GraphOptimisation(impl_->prepare());
}

const KeyframeTrajectory& PoseGraph::apply(const GraphOptimisation& optimisation) {
    impl_->apply(optimisation.task());
    impl_->thin_out();
    impl_->publish();
    return impl_->trajectory();
}

bool PoseGraph::adopt(const Surfaces& surfaces) {
    return impl_->adopt(surfaces);
}

const KeyframeTrajectory& PoseGraph::finish() {
    if (impl_->has_edges()) {
        impl_->optimise();
        impl_->publish();
    }
    return impl_->trajectory();
}

BentDepth PoseGraph::bent_depth(const CameraInfo& camera, const DepthCorrection& so_far,
                                const Flatness& flatness) const {
    return graph::bent_depth(impl_->task(), camera, so_far, flatness);
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

}  // namespace planemap::graph
