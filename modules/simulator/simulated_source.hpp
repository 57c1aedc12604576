// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/frame_range.hpp"
#include "core/frame_source.hpp"
#include "core/option_list.hpp"
#include "core/trajectory.hpp"
#include "simulator/path.hpp"
#include "simulator/sensor_model.hpp"

namespace planemap::simulator {

/// What is simulated; options_of() says what each is.
struct SimulatorOptions {
    std::string world = "office";  ///< see world_names()
    int frames = 0;
    std::uint64_t seed = 1;
    double rate_hz = 30;
    int width = 640, height = 480;
    bool noise = true;
    bool registered = true;
    double depth_units_per_metre = 1000;
    double depth_min_m = 0.5, depth_max_m = 4.0;
    double color_noise = 2.5;
    int blur_samples = 1;
    double shutter_s = 0.015;
    double color_jitter_s = 0;
    double exposure_drift = 0;
    double light = 1;
    double speed_m_s = 0.5;
    double turn_deg_s = 45;
    int visits = 0;
    std::string trajectory;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// By the keys of a name, "sim:WORLD?key=value&..."; all but the world. Refers to `options`, which must
/// outlive it.
OptionList options_of(SimulatorOptions& options);

/// The worlds there are.
std::vector<std::string> world_names();

/// For --help: the worlds, a line each, and the parameters that names take.
std::string simulator_help();

/// Reads "sim:WORLD?key=value&...". Throws std::invalid_argument for an unknown world or key (listing what
/// there is), a value that is not a number, or one out of range.
SimulatorOptions parse_simulator_name(const std::string& name);

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
    /// Exact pose of the depth camera at any time; the colour camera's when registered.
    Pose world_from_depth(std::int64_t time_us) const;
    /// What the depth camera sees of frame i without noise or range.
    View depth_view(std::size_t i) const;

    const World& world() const { return world_; }
    /// The colour camera's exact poses at the times of the selected frames, in order.
    Trajectory ground_truth() const;

  private:
    void walk();
    void follow_trajectory();
    RgbImage color(std::size_t i, const View& depth_view) const;
    double exposure_at(std::int64_t time_us) const;

    SimulatorOptions options_;
    World world_;
    CameraInfo camera_;
    DepthSensorOptions depth_options_;
    GaussianTable gaussian_;
    Trajectory path_;
    std::size_t first_ = 0, frame_count_ = 0, next_ = 0;  ///< frame_count_: one after the last
};

/// Writes the exact planes as JSON: {"world": name, "planes": [{"id", "name", "normal": [x, y, z], "d",
/// "area", "rectangles": [[4 corners]...]}]}; world frame (z up), metres, n.p + d = 0, normals towards the
/// visible side, corners counter-clockwise about the normal. Pictures are left out: they cover other
/// rectangles of their plane. `log` is the name of the log beside the file that it tells the truth of, and is
/// added as "log"; empty: none. Throws std::runtime_error naming the file.
void write_planes_truth(const std::filesystem::path& file, const World& world, const std::string& log = {});

}  // namespace planemap::simulator
