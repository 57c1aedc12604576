// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/known_keyframes.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

namespace planemap::odometry {
namespace {

constexpr std::size_t kNewest = 10;  // never dropped
constexpr int kAround = 20;          // keyframes before and after one

/// Metres, a radian counted as one.
double pose_distance(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm() + rotation_angle(a.inverse() * b);
}

}  // namespace

void KnownKeyframes::add(int id, int previous_id, const Pose& odom_from_keyframe, places::KeyframeView view) {
    KnownKeyframe keyframe;
    keyframe.id = id;
    if (const KnownKeyframe* previous = find(previous_id))
        keyframe.part = previous->part;
    else if (previous_id >= 0 && !keyframes_.empty())
        keyframe.part = keyframes_.back().part;  // what it goes on from was dropped
    else
        keyframe.part = parts_++;
    keyframe.odom_from_keyframe = odom_from_keyframe;
    keyframe.place = index_.add(view.descriptors);
    keyframe.view = std::move(view);
    keyframes_.push_back(std::move(keyframe));
    if (static_cast<int>(keyframes_.size()) > capacity_) drop_one();
}

void KnownKeyframes::clear() {
    keyframes_.clear();
    index_ = places::PlaceIndex();
}

void KnownKeyframes::drop_one() {
    std::size_t oldest_of_pair = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + kNewest < keyframes_.size(); ++i)
        for (std::size_t j = i + 1; j < keyframes_.size(); ++j) {
            if (keyframes_[i].part != keyframes_[j].part) continue;
            const double d =
                pose_distance(keyframes_[i].odom_from_keyframe, keyframes_[j].odom_from_keyframe);
            if (d >= nearest) continue;
            nearest = d;
            oldest_of_pair = i;
        }
    const auto dropped = keyframes_.begin() + static_cast<std::ptrdiff_t>(oldest_of_pair);
    index_.remove(dropped->place, dropped->view.descriptors);
    keyframes_.erase(dropped);
}

const KnownKeyframe* KnownKeyframes::find(int id) const {
    const auto found = std::find_if(keyframes_.begin(), keyframes_.end(),
                                    [&](const KnownKeyframe& keyframe) { return keyframe.id == id; });
    return found == keyframes_.end() ? nullptr : &*found;
}

std::vector<KnownKeyframes::Candidate> KnownKeyframes::candidates(
    std::span<const Descriptor> descriptors) const {
    const std::vector<double> scores = index_.scores(descriptors);
    std::vector<Candidate> ranked;
    for (const KnownKeyframe& keyframe : keyframes_) {
        const double score = scores[static_cast<std::size_t>(keyframe.place)];
        if (score > 0 || &keyframe == &keyframes_.back()) ranked.push_back({&keyframe, score});
    }
    std::reverse(ranked.begin(), ranked.end());
    if (ranked.size() > 1)
        std::stable_sort(ranked.begin() + 1, ranked.end(),
                         [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    return ranked;
}

std::vector<const KnownKeyframe*> KnownKeyframes::around(const KnownKeyframe& keyframe) const {
    std::vector<const KnownKeyframe*> around;
    for (const KnownKeyframe& other : keyframes_)
        if (other.part == keyframe.part && std::abs(other.id - keyframe.id) <= kAround)
            around.push_back(&other);
    return around;
}

}  // namespace planemap::odometry
