// SPDX-License-Identifier: BSD-3-Clause
// Keyframes remembered for relocalisation.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/plane.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"

namespace planemap::odometry {

/// A blurred, tiny, brightness-normalised copy of an image, to rank keyframes by likeness.
std::vector<float> make_thumbnail(const GrayImage& gray);

struct KnownKeyframe {
    int id = -1;
    Pose odom_from_keyframe = Pose::Identity();
    std::vector<Feature> features;
    std::vector<float> thumbnail;  ///< empty: its image is not known any more
    std::vector<Plane> planes =
        {};  ///< it saw, the largest first, camera frame; only of one whose image is not known
};

/// A bounded set of keyframes. When it is full, of the two keyframes nearest to each other (the newest ten
/// aside) the older one goes, so that what stays is spread over the space.
class KnownKeyframes {
  public:
    explicit KnownKeyframes(int capacity) : capacity_(capacity) {}

    void add(KnownKeyframe keyframe);
    void clear() { keyframes_.clear(); }

    /// The one with an id, or nullptr.
    const KnownKeyframe* find(int id) const;

    /// The newest keyframe and those most like the image (of those whose image is not known the newest
    /// first), at most `count`; pointers until the next add().
    std::vector<const KnownKeyframe*> candidates(const GrayImage& gray, int count) const;

  private:
    void drop_one();

    int capacity_;
    std::vector<KnownKeyframe> keyframes_;
};

}  // namespace planemap::odometry
