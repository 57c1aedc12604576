// SPDX-License-Identifier: BSD-3-Clause
#include "places/keyframe_view.hpp"

namespace planemap::places {

KeyframeView make_view(const Keyframe& keyframe, int max_features) {
    std::vector<const Feature*> sound;
    for (const Feature& feature : keyframe.features) {
        if (feature.point.z() > 0.01f && feature.point.norm() < 1000.0f) sound.push_back(&feature);
    }
    KeyframeView view;
    const std::size_t kept = std::min(sound.size(), static_cast<std::size_t>(max_features));
    view.points.reserve(kept);
    view.descriptors.reserve(kept);
    for (std::size_t i = 0; i < kept; ++i) {
        const Feature& feature = *sound[i * sound.size() / kept];
        const Eigen::Vector3d p = feature.point.cast<double>();
        const Eigen::Vector2d direction = p.head<2>() / p.z();
        view.low = view.points.empty() ? direction : Eigen::Vector2d(view.low.cwiseMin(direction));
        view.high = view.points.empty() ? direction : Eigen::Vector2d(view.high.cwiseMax(direction));
        view.points.push_back(p);
        view.descriptors.push_back(feature.descriptor);
    }
    view.regions = keyframe.regions;
    view.noise = keyframe.noise;
    return view;
}

double overlap(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b) {
    if (b.points.empty()) return 0;
    int seen = 0;
    for (const Eigen::Vector3d& p_b : b.points) seen += a.sees(a_from_b * p_b);
    return seen / static_cast<double>(b.points.size());
}

bool looks_at_the_same(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b) {
    constexpr double kFarthest = 1.0, kShare = 0.3;
    return a_from_b.translation().norm() < kFarthest && overlap(a, b, a_from_b) > kShare;
}

double mean_depth(const KeyframeView& view) {
    double sum = 0, count = 0;
    for (const Eigen::Vector3d& p : view.points) sum += p.z();
    if (!view.points.empty()) return sum / static_cast<double>(view.points.size());
    for (const PlanarRegion& region : view.regions) {
        sum += region.moments.sum.z();
        count += region.moments.count;
    }
    return count > 0 ? sum / count : 0;
}

std::size_t memory_bytes(const KeyframeView& view) {
    std::size_t bytes = view.points.capacity() * sizeof(Eigen::Vector3d) +
                        view.descriptors.capacity() * sizeof(Descriptor) +
                        view.regions.capacity() * sizeof(PlanarRegion);
    for (const PlanarRegion& region : view.regions) {
        for (const Ring& ring : region.outline.rings)
            bytes += sizeof(Ring) + ring.capacity() * sizeof(Eigen::Vector2d);
    }
    return bytes;
}

}  // namespace planemap::places
