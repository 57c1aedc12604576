// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "odometry/motion_prior.hpp"
#include "odometry/options.hpp"

namespace planemap::odometry {

/// One RGB-D frame; everything is viewed, not owned, and only during process().
struct OdometryFrame {
    std::int64_t utime = 0;                 ///< of the depth image, microseconds
    std::int64_t color_utime = 0;           ///< of the colour image, microseconds; 0: as utime
    const GrayImage* gray = nullptr;        ///< the colour camera's luma; nullptr: no colour
    const DepthImage* depth = nullptr;      ///< registered to the colour camera and of its size, raw units
    const CameraInfo* camera = nullptr;     ///< never nullptr
    std::span<const PlanarRegion> regions;  ///< of the depth image, colour camera's frame; may be empty;
                                            ///< invalid ones are ignored
};

/// What a frame says that those before it did not.
struct News {
    enum class Image {
        kNone,  ///< there is none
        kNew,
        kRepeated,  ///< one of the last again: a stream that hangs
        kLate,      ///< taken further from its depth image than the rate of frames explains
    };
    Image color = Image::kNone, depth = Image::kNone;

    bool any() const { return color == Image::kNew || depth == Image::kNew; }
    /// Whether no image had to be left out.
    bool is_whole() const { return color <= Image::kNew && depth <= Image::kNew; }
};

struct OdometryResult {
    /// Which of the frame's images were used: those that are new.
    News news;
    PriorUse prior = PriorUse::kNone;
    /// Of the depth image's moment (pose_utime = utime).
    OdometryEstimate estimate;
    /// The frame before, or one before that which had no result, became a keyframe, and is described by now:
    /// not in its own call, which tracks it and makes of it what the next frame is tracked against, so that
    /// none takes long. Of the frames that came since, this call's estimate is the first that may name it.
    std::optional<Keyframe> described;
    /// Set when the frame itself became a keyframe and is described already: one without an edge, or the
    /// first after resume(). The estimate of one that had a pose is still relative to the one before.
    std::optional<Keyframe> keyframe;
};

/// Camera motion from RGB-D frames in order of time. The odom frame is the first keyframe's camera frame.
///
/// The first frame with enough texture or surface becomes keyframe 0 at the identity; until then frames are
/// lost. A lost frame is looked for among the known keyframes; after max_lost_frames a new keyframe begins at
/// the last pose without an edge (previous_id = -1). Time that goes back (a log that starts again) and
/// another camera do the same at once.
///
/// An image that is not new is left out, and the other one tracks alone. With neither the pose stays, its
/// covariance grows, and the frame is stale.
class Odometry {
  public:
    /// Throws std::invalid_argument that names every bad option.
    explicit Odometry(const OdometryOptions& options);
    ~Odometry();
    Odometry(Odometry&&) noexcept;
    Odometry& operator=(Odometry&&) noexcept;

    /// Ids that the process before may have given without having remembered them.
    static constexpr int kIdsLeftOut = 100;

    /// Goes on where another Odometry ended that had made these keyframes (in order, the newest last): their
    /// ids are not given again, and the camera is lost until it finds a place that one of them saw, or for
    /// max_lost_frames. Call it before the first frame.
    void resume(std::span<const Keyframe> keyframes);
    /// Ids up to this one are another odometry's: the next frame begins a chain of its own beyond them.
    /// Precondition: at most kMostIdAfter.
    void start_after(int id);
    /// No odometry comes that far; there is room for a thousand million keyframes more.
    static constexpr int kMostIdAfter = 1000000000;

    /// What wheels or an IMU say, of the time before the frames that it is of use for; in order. False: it
    /// was left out (see MotionPriors). A frame whose own images say all goes on as without.
    bool hear(const MotionPrior& prior);

    /// Throws std::invalid_argument when depth or camera is missing, an image has not the colour camera's
    /// size, or a new camera is not valid; the state is then as it was.
    OdometryResult process(const OdometryFrame& frame);

    /// After the last frame: the keyframe that waits for the next one to be described, if one does.
    std::optional<Keyframe> finish();

  private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace planemap::odometry
