// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::places {

/// What loop closure keeps of a keyframe. All in its camera frame.
struct KeyframeView {
    std::vector<Eigen::Vector3d> points;  ///< metres, z > 0
    std::vector<Descriptor> descriptors;  ///< one a point
    std::vector<PlanarRegion> regions;
    DepthNoise noise;  ///< of the points along their rays, and of the regions
    Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  ///< range of x/z and y/z

    /// True when the point lies in front of the camera within the range of directions of its features.
    bool sees(const Eigen::Vector3d& p) const {
        return p.z() > 0 && (p.head<2>().array() >= p.z() * low.array()).all() &&
               (p.head<2>().array() <= p.z() * high.array()).all();
    }
};

/// Features without a point before the camera are left out; of more than max_features, evenly spread ones
/// stay.
KeyframeView make_view(const Keyframe& keyframe, int max_features);

/// Share of the points of b that a would see if b's camera stood at a_from_b; 0 without points.
double overlap(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b);

/// Whether a's camera looks at what b's shows, from a like place, if b's stands at a_from_b: within a metre
/// of it, and with a third of b's points in view. From farther away it may look at what hides them.
bool looks_at_the_same(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b);

/// Depth of what it shows on average: of its points or, without them, of its regions; 0 for an empty view.
double mean_depth(const KeyframeView& view);

/// Bytes it takes, by capacity.
std::size_t memory_bytes(const KeyframeView& view);

}  // namespace planemap::places
