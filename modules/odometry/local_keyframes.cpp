// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/local_keyframes.hpp"

#include <algorithm>

namespace planemap::odometry {

std::vector<cv::Point2f> LocalKeyframe::pixels() const {
    std::vector<cv::Point2f> pixels;
    pixels.reserve(points.size());
    for (const TrackPoint& point : points) pixels.push_back(point.pixel);
    return pixels;
}

void LocalKeyframes::add(LocalKeyframe keyframe) {
    keyframes_.push_back(std::move(keyframe));
    if (static_cast<int>(keyframes_.size()) > others_ + 1) keyframes_.erase(keyframes_.begin());
    current_ = keyframes_.size() - 1;
}

const LocalKeyframe* LocalKeyframes::find(int id) const {
    for (const LocalKeyframe& keyframe : keyframes_)
        if (keyframe.id == id) return &keyframe;
    return nullptr;
}

void LocalKeyframes::make_current(int id) {
    if (const LocalKeyframe* keyframe = find(id))
        current_ = static_cast<std::size_t>(keyframe - keyframes_.data());
}

void LocalKeyframes::renew(int id) {
    const LocalKeyframe* keyframe = find(id);
    if (!keyframe) return;
    const auto at = keyframes_.begin() + (keyframe - keyframes_.data());
    std::rotate(at, at + 1, keyframes_.end());
    current_ = keyframes_.size() - 1;
}

}  // namespace planemap::odometry
