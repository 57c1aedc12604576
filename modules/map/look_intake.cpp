// SPDX-License-Identifier: BSD-3-Clause
#include "map/look_intake.hpp"

#include <utility>

namespace planemap::map {

namespace {

/// The view of a keyframe that a look is more looks of; nullptr: none yet.
StoredKeyframe* view_of(const Look& look, StoredKeyframe& keyframe) {
    StoredKeyframe* view = nullptr;
    for_each_view(keyframe, [&](StoredKeyframe& other) {
        if (other.id == look.keyframe_id && other.number == look.number) view = &other;
    });
    // What a keyframe that went saw is what its heir saw, where it was not kept.
    return view == nullptr && look.number == 0 ? &keyframe : view;
}

}  // namespace

LookIntake::Anchor LookIntake::anchor_of(const Look& look, Keyframes& keyframes) const {
    Anchor anchor{nullptr, look.keyframe_from_camera};
    if (!is_placeable(anchor.keyframe_from_camera)) return anchor;
    Heirs::Place place{look.keyframe_id, look.keyframe_utime};
    for (std::size_t step = 0; step <= Heirs::kMost; ++step) {
        const auto known = keyframes.find(place.id);
        if (known != keyframes.end()) {
            if (known->second.utime == place.utime) anchor.keyframe = &known->second;
            return anchor;
        }
        if (!heirs_.follow(place, anchor.keyframe_from_camera)) return anchor;
    }
    return anchor;
}

Looked LookIntake::add(const Look& look, Keyframes& keyframes, MapLosses& losses) const {
    const Anchor anchor = anchor_of(look, keyframes);
    if (anchor.keyframe == nullptr) {
        ++losses.looks_refused;
        return {};
    }
    StoredKeyframe& keyframe = *anchor.keyframe;
    if (StoredKeyframe* view = view_of(look, keyframe)) {
        const int before = view->looks;
        view->see_again(look.looks, look.utime);
        return {view, view->looks - before, false, keyframe.id};
    }
    if (!look.is_news()) {
        ++losses.looks_refused;
        return {};
    }
    StoredKeyframe news = regions_.view(look.keyframe_id, look.utime, look.regions, keyframe.noise, losses);
    news.number = look.number;
    news.keyframe_from_camera = anchor.keyframe_from_camera;
    if (keyframe.world_from_camera)
        news.world_from_camera = *keyframe.world_from_camera * news.keyframe_from_camera;
    keyframe.take_later(std::move(news));
    StoredKeyframe* view = view_of(look, keyframe);
    return {view, 1, view != nullptr, keyframe.id};
}

void LookIntake::absorb(LookIntake&& other) {
    heirs_.absorb(std::move(other.heirs_));
}

}  // namespace planemap::map
