// SPDX-License-Identifier: BSD-3-Clause
// Keyframes remembered for relocalisation.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "places/keyframe_view.hpp"
#include "places/place_index.hpp"

namespace planemap::odometry {

struct KnownKeyframe {
    int id = -1;
    int part = 0;  ///< poses of one part are relative to each other, those of two parts are not
    Pose odom_from_keyframe = Pose::Identity();
    places::KeyframeView view;
    int place = -1;  ///< its number in the index
};

/// A bounded set of keyframes. When it is full, of the two keyframes of one part that are nearest to each
/// other (the newest ten aside) the older one goes, so that what stays is spread over the space.
class KnownKeyframes {
  public:
    explicit KnownKeyframes(int capacity) : capacity_(capacity) {}

    /// Remembers one, which is of the part of the keyframe `previous_id`; -1: of a new part.
    void add(int id, int previous_id, const Pose& odom_from_keyframe, places::KeyframeView view);
    void clear();

    /// The one with an id, or nullptr.
    const KnownKeyframe* find(int id) const;

    /// One that may show what a view shows, and the share of the view's rare features that it has too.
    struct Candidate {
        const KnownKeyframe* keyframe = nullptr;
        double score = 0;
    };
    /// The newest keyframe and all that share anything with the descriptors, the likest first; pointers until
    /// the next add().
    std::vector<Candidate> candidates(std::span<const Descriptor> descriptors) const;

    /// Those of its part that were made shortly before and after it, itself too: drift between them is small.
    std::vector<const KnownKeyframe*> around(const KnownKeyframe& keyframe) const;

  private:
    void drop_one();

    int capacity_;
    int parts_ = 0;
    std::vector<KnownKeyframe> keyframes_;
    places::PlaceIndex index_;
};

}  // namespace planemap::odometry
