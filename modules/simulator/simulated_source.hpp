// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/frame_range.hpp"
#include "core/frame_source.hpp"
#include "core/trajectory.hpp"
#include "simulator/depth_bias.hpp"
#include "simulator/lens.hpp"
#include "simulator/path.hpp"
#include "simulator/simulator_options.hpp"

namespace planemap::simulator {

/// Frames of a simulated sensor in a simulated world, with the exact truth. Every frame depends on the
/// options and its index alone.
class SimulatedSource : public FrameSource {
  public:
    /// Throws std::invalid_argument for bad options, std::runtime_error if the trajectory cannot be read.
    explicit SimulatedSource(const SimulatorOptions& options = {});

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return frame_count_ - first_; }
    ReadResult next(SensorFrame& frame) override;
    /// Leaves the others out; the numbers of frame() and utime() stay. Throws as frames_within().
    void select(const FrameRange& range);

    /// Frame i as sensed, in any order. Precondition: there is one.
    SensorFrame frame(std::size_t i) const;
    std::int64_t utime(std::size_t i) const;        ///< of its depth, microseconds
    std::int64_t color_utime(std::size_t i) const;  ///< of its colour, microseconds
    /// Exact pose of the colour camera at any time. World frame: z up.
    Pose world_from_color(std::int64_t time_us) const { return pose_at(path_, time_us); }
    /// Exact pose of the depth camera at any time; the colour camera's when registered without an error.
    Pose world_from_depth(std::int64_t time_us) const;
    /// What the depth camera sees of frame i without noise, range, bias or lens; `camera` is the true one.
    View depth_view(std::size_t i) const;
    /// What the depth camera would read of frame i without noise and range: with its lens, its bias and
    /// light that comes over second surfaces.
    View biased_view(std::size_t i) const;

    /// The world at rest: indices and names; where its bodies are at a time is in world_at().
    const World& world() const { return world_; }
    World world_at(std::int64_t time_us) const { return world_.at(seconds_of(time_us)); }
    /// Seconds after the world's change.
    double seconds_of(std::int64_t time_us) const;
    const SimulatorOptions& options() const { return options_; }
    /// The cameras as they are, where camera() is what is said of them.
    const TrueCameras& true_cameras() const { return true_; }
    /// The specimen's bias; none: it has none.
    const std::optional<DepthBias>& bias() const { return bias_; }
    /// The hand that carries the camera along world().tour.
    HandOptions hand() const;
    /// What wheels and gyroscopes would say of the robot's body, 50 times a second: local_from_body, the
    /// first one the identity, drifting by options().motion_noise. Precondition: options().mounted.
    Trajectory body_motion() const;
    /// The colour camera's exact poses at the times of the selected frames, in order.
    Trajectory ground_truth() const;

  private:
    void walk();
    void follow_trajectory();
    RgbImage color(std::size_t i, const World& now, const View& depth_view) const;
    /// world() where nothing moves, else world_at(), which is put into `moved`.
    const World& world_then(std::int64_t time_us, World& moved) const;
    void distort(const World& now, View& view) const;
    double exposure_at(std::int64_t time_us) const;

    SimulatorOptions options_;
    World world_;
    CameraInfo camera_;
    TrueCameras true_;
    std::optional<DepthBias> bias_;
    std::optional<Lens> depth_lens_, color_lens_;  ///< always there
    DepthSensorOptions depth_options_;
    GaussianTable gaussian_;
    Trajectory path_;
    std::size_t first_ = 0, frame_count_ = 0, next_ = 0;  ///< frame_count_: one after the last
};

}  // namespace planemap::simulator
