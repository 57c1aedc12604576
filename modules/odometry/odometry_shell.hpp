// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <span>

#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/journal.hpp"
#include "messages/process.hpp"
#include "odometry/body_frame.hpp"
#include "odometry/looks.hpp"
#include "odometry/odometry.hpp"
#include "odometry/registration_check.hpp"

namespace planemap::odometry {

/// OPENNI_FRAME and PLANEMAP_REGIONS of the same utime to PLANEMAP_ODOMETRY, POSE_BODY, PLANEMAP_KEYFRAME
/// and PLANEMAP_LOOK.
/// POSE_BODY begins when it is known how the body lies (BodyFrame): by camera.json, else by the up of
/// PLANEMAP_MAP, which is asked until then.
/// A frame waits for its regions until a later one's come, kMaxWaiting frames wait, or it has waited for
/// kMaxWait; then it goes on without. After kMaxMissing of these in a row (no segmentation on the bus) frames
/// do not wait, until regions come again.
///
/// With a journal, which a path names, a process that is started again knows the keyframes that it made:
/// their ids are not given again, and it is lost until it finds a place that they saw. The keyframes of the
/// last seconds are sent again when a module that lives on them was started again.
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
    using Clock = std::chrono::steady_clock;
    /// More than the segmentation has in its queue and at work: it drops what comes beyond that.
    static constexpr std::size_t kMaxWaiting = 8;
    static constexpr std::chrono::milliseconds kMaxWait{500};
    static constexpr std::chrono::seconds kSendAgain{5};  ///< keyframes of so long
    static constexpr int kMaxMissing = 10;  ///< frames in a row without regions, then nothing waits

    struct Waiting {
        std::shared_ptr<const messages::Frame> frame;
        std::optional<messages::FrameRegions> regions;
        Clock::time_point since = Clock::now();
    };
    void on_frame(std::shared_ptr<const messages::Frame> frame);
    void on_regions(const messages::RawMessage& message);
    void on_trajectory(const messages::RawMessage& message);
    void on_map(const messages::RawMessage& message);
    void publish_body(OdometryEstimate estimate, const CameraInfo& camera);
    void process_ready(std::size_t max_waiting);
    void process_front();
    void process(const Waiting& input);
    void resume();
    void tend_journal();
    void count(const News& news);
    void count(PriorUse prior);
    void hear_priors(const std::string& channel);
    void on_prior(const messages::RawMessage& message);
    void remember_chain(const Keyframe& keyframe);
    void publish(const Keyframe& keyframe);
    void publish_look(const OdometryResult& result, std::span<const PlanarRegion> regions);
    void on_status(const messages::RawMessage& message);
    void send_again();

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    Odometry odometry_;
    RegistrationCheck registration_;
    messages::ModuleStatus status_{"odometry"};
    std::deque<Waiting> waiting_;
    std::deque<messages::FrameRegions>
        early_regions_;  ///< of frames that have not come yet; at most kMaxWaiting
    /// The first keyframe of an odom frame, by which a trajectory says how that lies in the world.
    struct Start {
        int id;
        std::int64_t utime;
        Pose odom_from_camera;
    };
    BodyFrame body_;
    Looks looks_;
    std::optional<Start> first_keyframe_;
    int first_chain_ = -1;                 ///< of that one
    int newest_id_ = -1;                   ///< of the keyframes so far, ours and those of before
    std::map<int, Start> apart_;           ///< by chain: those of which it is not known how they lie
    std::map<int, Pose> first_from_odom_;  ///< by chain: those of which it is; the newest
    bool is_silent_ = false;               ///< POSE_BODY is, since that is not known of the present one
    std::optional<Pose> odom_from_world_;
    std::optional<std::int64_t> frames_told_utime_;  ///< frame with which the body's frames were told last
    std::optional<std::int64_t> handled_utime_;      ///< of the last frame that was handled
    int missing_ = 0;                                ///< frames in a row that waited in vain
    bool heard_ = false;                             ///< a message came since the last poll()
    std::int32_t odometry_seq_ = 0, keyframe_seq_ = 0, look_seq_ = 0;
    std::unique_ptr<messages::Journal> journal_;  ///< null without
    struct Sent {
        Clock::time_point at;
        std::vector<std::uint8_t> bytes;
    };
    std::deque<Sent> sent_;                         ///< the last keyframes
    std::map<std::string, std::int64_t> sessions_;  ///< of the modules that live on them
};

}  // namespace planemap::odometry
