// SPDX-License-Identifier: BSD-3-Clause
#include "map/map.hpp"

#include <utility>

#include "core/geometry/angle.hpp"
#include "map/hand_over.hpp"
#include "map/rebuild.hpp"
#include "map/region_planes.hpp"
#include "map/rules.hpp"
#include "map/starting_planes.hpp"

namespace planemap::map {

namespace {

constexpr std::size_t kMaxWaiting = 4096;
/// Keyframes near one that goes, which take over what it saw.
constexpr std::size_t kHeirs = 8;

MapOptions validated(const MapOptions& options) {
    options.validate();
    return options;
}

}  // namespace

PlaneMapper::PlaneMapper(const MapOptions& options, PlaneIds ids, std::shared_ptr<ToldUp> told)
    : options_(validated(options)),
      keyframes_(options.max_extent_m),
      planes_(options, std::move(ids)),
      derived_(derivation_rules(options), adjacency_rules(options), inference_rules(options)),
      seen_before_(options.see_through_m),
      told_(std::move(told)) {}

void PlaneMapper::start_from(const PlaneMap& map, const SeenSpace& seen) {
    seen_before_.start_from(seen);
    StartingPlanes start = starting_planes(map, options_.max_extent_m, options_.outline_cell_m);
    losses_.planes_refused += start.refused;
    work_.coarsened += start.coarsened;
    for (PlaneEstimate& plane : start.planes) planes_.start_from(std::move(plane));
    derived_.start_from(map);
    rebuild();
    refresh();
    derived_.take_labels(map);
    infer();
}

void PlaneMapper::add(const Keyframe& keyframe) {
    if (keyframes_.add(keyframe, losses_) == KeyframeStore::Arrival::kRefused) return;
    told_->came(keyframe.id, keyframe.utime);
    place(keyframe.id);
    losses_.keyframes_unplaced += keyframes_.drop_waiting(kMaxWaiting);
    refresh();
}

void PlaneMapper::add(const Keyframe& keyframe, const Pose& world_from_camera) {
    keyframes_.set_pose(keyframe.id, world_from_camera);
    add(keyframe);
}

bool PlaneMapper::add(const Look& look) {
    const Looked looked = keyframes_.add(look, losses_);
    if (looked.view == nullptr || !looked.view->world_from_camera) return false;
    settled_ = false;
    if (looked.is_news) {
        planes_.integrate(looked.keyframe_id, *looked.view, keyframes_, losses_);
    } else if (looked.more > 0) {
        planes_.see_again(*looked.view, looked.more);
    }
    if (looked.more > 0) derived_.seen_at(look.utime);
    const bool has_changed = planes_.has_changed();
    refresh();
    return has_changed;
}

void PlaneMapper::update(const KeyframeTrajectory& trajectory) {
    hand_over_replaced(trajectory);
    const KeyframeStore::Motion motion =
        keyframes_.update(trajectory.keyframes, {options_.moved_m, radians(options_.moved_deg)}, losses_);
    settled_ = settled_ && !motion.any;
    derived_.set_revision(trajectory.revision);
    if (!trajectory.keyframes.empty()) derived_.set_component(trajectory.keyframes.front().component);
    const bool is_anew = motion.of_note || std::exchange(absorbed_, false);
    if (is_anew) {
        rebuild();
    } else {
        for (const KeyframePose& named : trajectory.keyframes)
            if (keyframes_.is_waiting(named.id)) place(named.id);
    }
    refresh();
    if (is_anew) infer();
}

void PlaneMapper::absorb(PlaneMapper&& other) {
    keyframes_.absorb(std::move(other.keyframes_));
    losses_ += other.losses_;
    work_ += other.work_;
    settled_ = false;
    absorbed_ = true;
}

void PlaneMapper::restore_ids(const Surfaces& surfaces) {
    recall_surfaces(surfaces, keyframes_, planes_);
    rebuild();
    refresh();
    infer();
}

void PlaneMapper::settle() {
    if (settled_) return;
    rebuild();
    refresh();
    infer();
}

/// Puts a keyframe into the map if its pose is known.
void PlaneMapper::place(int keyframe_id) {
    const StoredKeyframe* keyframe = keyframes_.place(keyframe_id);
    if (keyframe == nullptr) return;
    settled_ = false;
    planes_.integrate(keyframe_id, keyframes_, losses_);
    derived_.seen_at(keyframe->utime);
    fold();
}

/// Lets keyframes go that are taken not to move any more.
void PlaneMapper::fold() {
    if (options_.fold_after == 0) return;
    const std::map<int, StoredKeyframe>& keyframes = keyframes_.keyframes();
    if (keyframes.size() > static_cast<std::size_t>(options_.fold_after)) derived_.keep_inferred();
    while (keyframes.size() > static_cast<std::size_t>(options_.fold_after)) {
        const auto& [id, keyframe] = *keyframes.begin();
        if (!keyframe.world_from_camera) return;
        planes_.fold(id, keyframe);
        for_each_view(keyframe, [&](const StoredKeyframe& view) { seen_before_.look(Viewpoint(view)); });
        keyframes_.retire_oldest();
        ++work_.folded;
    }
}

/// Lets keyframes go that the graph replaced; what they saw goes over to those near them.
void PlaneMapper::hand_over_replaced(const KeyframeTrajectory& trajectory) {
    for (StoredKeyframe& gone : keyframes_.take_replaced(trajectory.keyframes)) {
        const std::vector<StoredKeyframe*> heirs = keyframes_.nearest(*gone.world_from_camera, kHeirs);
        hand_over(gone, heirs,
                  [&](const StoredRegion& r) { return planes_.model().reliability(r, gone.noise).sigma_m; });
        keyframes_.redirect_looks(gone, *heirs.front());
        hand_over_looks(std::move(gone), *heirs.front());
        ++work_.replaced;
        settled_ = false;
    }
}

void PlaneMapper::rebuild() {
    ++work_.rebuilds;
    planes_.rebuild(keyframes_);
    for (const auto& [id, keyframe] : keyframes_.keyframes())
        if (keyframe.world_from_camera) derived_.seen_at(keyframe.utime);
    settled_ = true;
}

/// Infers what is hidden of the planes as they are after a rebuild.
void PlaneMapper::infer() {
    derived_.infer(options_.infer_hidden ? viewpoints(keyframes_) : std::vector<Viewpoint>());
}

Surfaces PlaneMapper::surfaces() const {
    return surfaces_of(keyframes_, map().utime);
}

SeenSpace PlaneMapper::seen_space(const std::function<bool()>& goes_on) const {
    return seen_through(seen_before_, viewpoints(keyframes_), goes_on);
}

std::size_t PlaneMapper::working_bytes() const {
    return keyframes_.memory_bytes() + planes_.memory_bytes() + derived_.working_bytes() +
           seen_before_.memory_bytes();
}

}  // namespace planemap::map
