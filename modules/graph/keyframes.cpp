// SPDX-License-Identifier: BSD-3-Clause
#include "graph/keyframes.hpp"

#include <algorithm>
#include <utility>

namespace planemap::graph {

int Keyframes::node_of(int id) const {
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), id,
                                        [](const auto& node, int wanted) { return node.id < wanted; });
    return found != nodes_.end() && found->id == id ? static_cast<int>(found - nodes_.begin()) : -1;
}

int Keyframes::newest_of_chain(int chain) const {
    for (int node = newest(); node >= 0; --node)
        if (nodes_[at(node)].chain == chain) return node;
    return -1;
}

void Keyframes::add(KeyframeNode node, const Pose& world_from_camera, int parent) {
    nodes_.push_back(std::move(node));
    poses_.push_back(world_from_camera);
    parents_.push_back(parent);
}

void Keyframes::carry(const std::vector<bool>& moving, const Pose& move) {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        if (moving[i]) poses_[i] = orthonormalised(move * poses_[i]);
    }
}

std::vector<Pose> Keyframes::follow(const std::vector<Pose>& optimised) {
    std::vector<Pose> moves;
    moves.reserve(poses_.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        const Pose before = poses_[i];
        poses_[i] = i < optimised.size() ? optimised[i] : orthonormalised(moves[at(parents_[i])] * poses_[i]);
        moves.push_back(poses_[i] * before.inverse(Eigen::Isometry));
    }
    return moves;
}

void Keyframes::remove(int node, int keeper) {
    for (int& base : parents_) {
        if (base == node) base = keeper;
        if (base > node) --base;
    }
    parents_.erase(parents_.begin() + node);
    nodes_.erase(nodes_.begin() + node);
    poses_.erase(poses_.begin() + node);
}

std::size_t Keyframes::memory_bytes() const {
    std::size_t bytes = 0;
    for (const KeyframeNode& node : nodes_) bytes += sizeof node + places::memory_bytes(node.view);
    return bytes;
}

}  // namespace planemap::graph
