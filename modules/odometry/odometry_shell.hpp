// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "odometry/body_frame.hpp"
#include "odometry/keyframe_outbox.hpp"
#include "odometry/looks.hpp"
#include "odometry/loose_keyframes.hpp"
#include "odometry/odom_frames.hpp"
#include "odometry/odometry.hpp"
#include "odometry/region_pairing.hpp"
#include "odometry/registration_check.hpp"

namespace planemap::odometry {

/// OPENNI_FRAME and PLANEMAP_REGIONS of the same utime to PLANEMAP_ODOMETRY, POSE_BODY, PLANEMAP_KEYFRAME
/// and PLANEMAP_LOOK.
/// POSE_BODY begins when it is known how the body lies (BodyFrame): by camera.json, else by the up of
/// PLANEMAP_MAP, which is asked until then.
/// How frames wait for their regions: RegionPairing.
///
/// With a journal, which a path names, a process that is started again knows the keyframes that it made
/// (KeyframeOutbox): their ids are not given again, and it is lost until it finds a place that they saw.
class OdometryShell : public messages::Shell {
  public:
    OdometryShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                  const OdometryOptions& options, const std::filesystem::path& journal = {});

    /// Reasons in status().losses() for frames that were not tracked; others had depth that could be used.
    static constexpr const char* kNoReadings = "untracked frames with hardly a depth reading in range";
    static constexpr const char* kBesideColor = "untracked frames whose depth lies beside the colour image";

    /// Reasons for images that were left out, since they say nothing of their moment.
    static constexpr const char* kColorRepeats = "colour images left out that are one of the last again";
    static constexpr const char* kDepthRepeats = "depth images left out that are one of the last again";
    static constexpr const char* kColorLate =
        "colour images left out that are of another time than their depth";

    /// Reasons for motion priors (--motion-channel) that were not used.
    static constexpr const char* kPriorBroken = "motion priors that are none, came twice or late";
    static constexpr const char* kPriorNoMount =
        "frames without their motion prior: camera.json has no body_from_camera";
    static constexpr const char* kPriorStale = "frames that no motion prior reached";
    static constexpr const char* kPriorContradicts =
        "motion priors further from what the camera saw than both allow";
    static constexpr const char* kPriorDistrusted =
        "motion priors not used, since others contradicted before";

    messages::ModuleStatus& status() override { return status_; }
    /// Goes on with what has waited for too long.
    int poll() override;
    /// Handles the frames that still wait.
    void finish() override;

  private:
    void on_trajectory(const messages::RawMessage& message);
    void on_map(const messages::RawMessage& message);
    void publish_keyframe(const Keyframe& keyframe);
    void publish_body(OdometryEstimate estimate, const CameraInfo& camera);
    void process(const FrameWithRegions& input);
    OdometryResult track(const OdometryFrame& frame);
    void add_colour(const messages::Frame& frame, OdometryFrame& in);
    void resume();
    void count(const News& news);
    void count(PriorUse prior);
    void hear_priors(const std::string& channel);
    void on_prior(const messages::RawMessage& message);
    void publish_look(const OdometryResult& result, std::span<const PlanarRegion> regions);

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    Odometry odometry_;
    RegistrationCheck registration_;
    messages::ModuleStatus status_{"odometry"};
    RegionPairing pairing_;
    KeyframeOutbox outbox_;
    BodyFrame body_;
    OdomFrames frames_;
    Looks looks_;
    LooseKeyframes loose_{status_};
    std::string motion_channel_;  ///< empty: none
    bool heard_prior_ = false;
    int newest_id_ = -1;      ///< of the keyframes so far, ours and those of before
    bool is_silent_ = false;  ///< POSE_BODY is, since how the present odom frame lies is not known
    std::optional<std::int64_t> frames_told_utime_;  ///< frame with which the body's frames were told last
    std::int32_t odometry_seq_ = 0, look_seq_ = 0;
};

}  // namespace planemap::odometry
