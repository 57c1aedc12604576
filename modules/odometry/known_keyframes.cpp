// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/known_keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

constexpr int kThumbnailWidth = 40, kThumbnailHeight = 30;
constexpr std::size_t kNewest = 10;  // never dropped

double likeness(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return -1;
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Metres, a radian counted as one.
double pose_distance(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm() + rotation_angle(a.inverse() * b);
}

}  // namespace

std::vector<float> make_thumbnail(const GrayImage& gray) {
    cv::Mat small, blurred;
    cv::resize(as_mat(gray), small, {kThumbnailWidth, kThumbnailHeight}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(small, blurred, {5, 5}, 1.2);
    std::vector<float> values(blurred.begin<unsigned char>(), blurred.end<unsigned char>());
    const float mean =
        std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
    for (float& value : values) value -= mean;
    const auto norm = static_cast<float>(std::sqrt(likeness(values, values)));
    if (norm > 0)
        for (float& value : values) value /= norm;
    return values;
}

void KnownKeyframes::add(KnownKeyframe keyframe) {
    keyframes_.push_back(std::move(keyframe));
    if (static_cast<int>(keyframes_.size()) > capacity_) drop_one();
}

void KnownKeyframes::drop_one() {
    std::size_t oldest_of_pair = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + kNewest < keyframes_.size(); ++i)
        for (std::size_t j = i + 1; j < keyframes_.size(); ++j) {
            const double d =
                pose_distance(keyframes_[i].odom_from_keyframe, keyframes_[j].odom_from_keyframe);
            if (d >= nearest) continue;
            nearest = d;
            oldest_of_pair = i;
        }
    keyframes_.erase(keyframes_.begin() + static_cast<std::ptrdiff_t>(oldest_of_pair));
}

const KnownKeyframe* KnownKeyframes::find(int id) const {
    const auto found = std::find_if(keyframes_.begin(), keyframes_.end(),
                                    [&](const KnownKeyframe& keyframe) { return keyframe.id == id; });
    return found == keyframes_.end() ? nullptr : &*found;
}

std::vector<const KnownKeyframe*> KnownKeyframes::candidates(const GrayImage& gray, int count) const {
    if (keyframes_.empty() || count < 1) return {};
    const std::vector<float> thumbnail = make_thumbnail(gray);
    std::vector<std::pair<double, const KnownKeyframe*>> ranked;
    ranked.reserve(keyframes_.size());
    for (const KnownKeyframe& keyframe : keyframes_)
        ranked.emplace_back(&keyframe == &keyframes_.back() ? 2.0 : likeness(thumbnail, keyframe.thumbnail),
                            &keyframe);
    std::reverse(ranked.begin(), ranked.end());
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const KnownKeyframe*> best;
    for (const auto& [like, keyframe] : ranked)
        if (static_cast<int>(best.size()) < count) best.push_back(keyframe);
    return best;
}

}  // namespace planemap::odometry
