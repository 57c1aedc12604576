// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "odometry/camera_motion.hpp"
#include "odometry/known_keyframes.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/options.hpp"
#include "odometry/tracker.hpp"
#include "places/verification.hpp"

namespace planemap::odometry {

/// Finds a lost camera again by what earlier keyframes saw. A place is known again when the view stands the
/// verification of loop closures against a keyframe, what was seen around that keyframe does not speak
/// against it, and no other remembered keyframe that the camera may be at explains the view as well: where
/// two places look alike, neither is taken.
class Relocaliser {
  public:
    explicit Relocaliser(const OdometryOptions& options);

    /// Remembers a keyframe, edge included.
    void add(const Keyframe& keyframe);
    void clear() { known_.clear(); }

    /// Where the frame is, by at most relocalisation_tries keyframes, the likest first; at most four times as
    /// many more verifications ask whether it may be elsewhere; refined by flow where the keyframe is still a
    /// local one. Nothing when none fits, several do, or the camera cannot have come there. Precondition: the
    /// frame has colour.
    std::optional<Located> locate(const PreparedFrame& frame, const CameraMotion& motion,
                                  const LocalKeyframes& local) const;

  private:
    /// A frame that is asked about.
    struct Query {
        const PreparedFrame& frame;
        const CameraMotion& motion;
        places::KeyframeView view;
    };
    /// One answer.
    struct Explanation {
        const KnownKeyframe* keyframe = nullptr;
        places::Verification verification;
        double score = 0;

        Pose odom_from_camera() const { return keyframe->odom_from_keyframe * verification.a_from_b; }
    };

    std::optional<Explanation> explain(const Query& query, const KnownKeyframes::Candidate& candidate,
                                       const places::VerificationOptions& options) const;
    bool is_contradicted(const Explanation& explanation, const places::KeyframeView& view) const;
    bool has_rival(const Query& query, const Explanation& found,
                   std::span<const KnownKeyframes::Candidate> candidates) const;
    bool has_twin(const Query& query, const Explanation& found) const;
    Located located(const Query& query, const Explanation& found, const LocalKeyframes& local) const;

    OdometryOptions options_;
    places::VerificationOptions verification_;
    KnownKeyframes known_;
};

}  // namespace planemap::odometry
