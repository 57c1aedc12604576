// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_building.hpp"

#include <thread>
#include <utility>

namespace planemap::octomap {

TreeBuilding::TreeBuilding(const OctomapOptions& options, Building building)
    : options_(options), builder_(std::make_unique<OctomapBuilder>(options)) {
    if (building == Building::kInBackground) worker_ = std::make_unique<OctomapWorker>(*builder_);
}

TreeBuilding::~TreeBuilding() {
    if (!worker_) return;
    worker_.reset();
    // To free millions of nodes one by one takes longer than a stop may: the end of the process does not wait
    // for it.
    std::thread([left = std::move(builder_)] {}).detach();
}

void TreeBuilding::begin_update(const KeyframeTrajectory& trajectory) {
    utime_ = trajectory.utime;
    revision_ = trajectory.revision;
    if (!worker_) builder_->update(trajectory);
}

void TreeBuilding::end_update(const KeyframeTrajectory& trajectory) {
    if (worker_) worker_->update(trajectory);
}

bool TreeBuilding::add(ScanId id, const std::shared_ptr<const StoredScan>& scan,
                       const Pose& world_from_camera, const ScanAnchor& anchor) {
    return worker_ ? worker_->add(id, scan, world_from_camera, anchor)
                   : builder_->add(id, scan, world_from_camera, anchor);
}

std::size_t TreeBuilding::start_over() {
    const bool was_in_background = is_in_background();
    worker_.reset();
    const std::size_t lost = builder_->keyframes_in_tree() + builder_->waiting();
    builder_ = std::make_unique<OctomapBuilder>(options_);
    if (was_in_background) worker_ = std::make_unique<OctomapWorker>(*builder_);
    return lost;
}

std::optional<OctomapState> TreeBuilding::newer_state() {
    return worker_->newer_state();
}

OctomapState TreeBuilding::state_up_to_date() {
    builder_->flush();
    OctomapState state;
    state.sizes = builder_->sizes();
    state.keyframes = builder_->keyframes_in_tree();
    state.frozen = builder_->frozen();
    state.utime = utime_;
    state.revision = revision_;
    state.is_up_to_date = true;
    return state;
}

void TreeBuilding::finish(std::chrono::milliseconds patience) {
    worker_->finish(patience);
}

}  // namespace planemap::octomap
