// SPDX-License-Identifier: BSD-3-Clause
#include "graph/topology.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace planemap::graph {

namespace {

double whitened_error(const PoseEdge& edge, const std::vector<Pose>& poses) {
    return edge_error(edge, poses[at(edge.from)], poses[at(edge.to)]).norm();
}

}  // namespace

void Topology::add_odometry(const Tie& tie) {
    odometry_.push_back(tie);
    link(tie);
}

void Topology::add_gap(const Tie& tie) {
    gaps_.push_back(tie);
    link(tie);
}

void Topology::add_loop(const Tie& tie) {
    loops_.push_back(tie);
    link(tie, static_cast<int>(loops_.size()) - 1);
}

void Topology::link(const Tie& tie, int loop) {
    links_[at(tie.edge.from)].push_back({tie.edge.to, tie.drift, tie.is_step, loop});
    links_[at(tie.edge.to)].push_back({tie.edge.from, tie.drift, tie.is_step, loop});
}

UnionFind<int> Topology::parts() const {
    UnionFind<int> parts(links_.size());
    for (const auto* ties : {&odometry_, &loops_}) {
        for (const Tie& tie : *ties) parts.join(tie.edge.from, tie.edge.to);
    }
    return parts;
}

std::vector<PoseEdge> Topology::edges(bool to_start_with) const {
    std::vector<PoseEdge> edges;
    UnionFind<int> parts(links_.size());
    for (const Tie& tie : odometry_) {
        edges.push_back(tie.edge);
        parts.join(tie.edge.from, tie.edge.to);
    }
    for (const Tie& tie : loops_) {
        if (to_start_with && tie.weight < kDistrusted) continue;
        edges.push_back(tie.edge);
        edges.back().robust = !to_start_with || tie.is_known;
        parts.join(tie.edge.from, tie.edge.to);
    }
    for (const Tie& gap : gaps_) {
        if (parts.join(gap.edge.from, gap.edge.to)) edges.push_back(gap.edge);
    }
    return edges;
}

bool Topology::holds(const Link& link) const {
    if (link.loop < 0) return true;
    const Tie& loop = loops_[at(link.loop)];
    return loop.is_applied && loop.weight >= kDistrusted;
}

std::vector<Drift> Topology::drifts_from(int source) const {
    std::vector<Drift> drifts(links_.size());
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

std::vector<bool> Topology::within_steps(int node, int steps) const {
    std::vector<bool> near(links_.size(), false);
    near[at(node)] = true;
    std::vector<int> ring{node};
    for (int step = 1; step < steps; ++step) {
        std::vector<int> next;
        for (const int from : ring) {
            for (const Link& link : links_[at(from)]) {
                if (!link.is_step || near[at(link.other)]) continue;
                near[at(link.other)] = true;
                next.push_back(link.other);
            }
        }
        ring = std::move(next);
    }
    return near;
}

std::optional<Tie> Topology::nearest_trusted(int node, const std::vector<Pose>& poses) const {
    constexpr double kTrusted = 0.5;  // weight of a loop closure
    std::optional<Tie> best;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto* ties : {&odometry_, &loops_}) {
        for (const Tie& tie : *ties) {
            if (!tie.touches(node) || tie.weight < kTrusted) continue;
            const Pose apart = poses[at(tie.other(node))].inverse(Eigen::Isometry) * poses[at(node)];
            const double distance = apart.translation().norm() + rotation_angle(apart);
            if (distance >= nearest) continue;
            nearest = distance;
            best = tie;
        }
    }
    return best;
}

bool Topology::has_unapplied_loop(int node) const {
    return std::any_of(loops_.begin(), loops_.end(),
                       [&](const Tie& tie) { return tie.touches(node) && !tie.is_applied; });
}

bool Topology::has_new_loops() const {
    return std::any_of(loops_.begin(), loops_.end(), [](const Tie& tie) { return !tie.is_known; });
}

double Topology::worst_new_loop(const std::vector<Pose>& poses) const {
    double worst = 0;
    for (const Tie& tie : loops_) {
        if (!tie.is_known) worst = std::max(worst, whitened_error(tie.edge, poses));
    }
    return worst;
}

std::vector<PoseEdge> Topology::new_loops() const {
    std::vector<PoseEdge> edges;
    for (const Tie& tie : loops_) {
        if (!tie.is_known) edges.push_back(tie.edge);
    }
    return edges;
}

void Topology::mark_known() {
    for (Tie& tie : loops_) tie.is_known = true;
}

void Topology::weigh(std::size_t known, const std::vector<Pose>& poses, double kernel_width) {
    for (std::size_t i = 0; i < loops_.size(); ++i) {
        Tie& tie = loops_[i];
        tie.is_applied = tie.is_applied || i < known;
        const double error = whitened_error(tie.edge, poses);
        tie.weight = 1 / (1 + error * error / (kernel_width * kernel_width));
    }
}

void Topology::hand_over(const Tie& to_keeper, int gone, const std::vector<Pose>& poses) {
    for (auto* ties : {&odometry_, &loops_, &gaps_}) graph::hand_over(*ties, to_keeper, gone, poses);
    links_.assign(links_.size() - 1, {});
    for (const Tie& tie : odometry_) link(tie);
    for (const Tie& tie : gaps_) link(tie);
    for (std::size_t i = 0; i < loops_.size(); ++i) link(loops_[i], static_cast<int>(i));
}

std::size_t Topology::memory_bytes() const {
    std::size_t bytes = links_.size() * sizeof(std::vector<Link>);
    for (const auto* ties : {&odometry_, &loops_, &gaps_}) bytes += ties->capacity() * sizeof(Tie);
    for (const std::vector<Link>& links : links_) bytes += links.capacity() * sizeof(Link);
    return bytes;
}

}  // namespace planemap::graph
