// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bot_core/images_t.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "messages/convert.hpp"
#include "messages/process.hpp"
#include "sensor/position_file.hpp"
#include "sensor/read_ahead.hpp"
#include "sensor/source.hpp"

namespace planemap::sensor {

/// Options of SensorShell; pacing_of() and encoding_of() say what each is.
struct SensorShellOptions {
    double rate_hz = 0;
    double speed = 1;
    bool restamp = false;
    std::string color = "jpeg";
    std::string depth = "zipped";
    int jpeg_quality = 94;
    bool live = false;  ///< as a process of its own: the source is read on a thread of its own, and the
                        ///< camera is told once a second by the wall clock. Otherwise all happens in poll(),
                        ///< and by the time of the data: the same source gives the same messages

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;

    /// How far the source was played is kept in this file, so that a process that is started again goes on
    /// there; empty: in none. Frames of a camera have stamps of now: none is left out.
    std::filesystem::path position;
};

/// Publishes a source's frames (OPENNI_FRAME), what its accelerometer read before each
/// (PLANEMAP_ACCELERATION), and its camera (PLANEMAP_CAMERA_INFO at the start, once a
/// second, and as a process of its own when a module on the network says that it was started just now). A
/// fault of the source is logged when it is first seen, and counted.
class SensorShell : public messages::Shell {
  public:
    SensorShell(messages::Bus& bus, std::unique_ptr<FrameSource> source, SensorShellOptions options);

    messages::ModuleStatus& status() override { return status_; }
    /// Reads the next frame, or publishes it if it is due; negative at the end of the source. Without a
    /// connection nothing is read: a recording goes on when there is one.
    int poll() override;
    /// Throws std::runtime_error if the source came to its end without one frame that could be used, or what
    /// it made beside its frames (a recording) failed.
    void finish() override;

    const FrameSource& source() const { return *source_; }
    std::int64_t frames() const { return frames_; }          ///< published
    std::int64_t broken() const { return broken_; }          ///< skipped: they could not be read
    std::int64_t last_utime() const { return last_utime_; }  ///< of the frame published last
    std::int64_t colorless() const {
        return colorless_;
    }  ///< published without their colour, which could not be read
    std::int64_t ends_missing() const {
        return ends_missing_;
    }  ///< published, though a file of them is cut short behind its last pixel

    /// What a live camera lost, by its reason.
    const std::map<std::string, std::int64_t>& camera_losses() const { return camera_losses_; }

  private:
    enum class Read { kFrame, kNothing, kEnd };

    void restamp(std::int64_t utime);
    void publish(const SensorFrame& frame);
    void publish_camera(std::int64_t utime);
    bool camera_is_due(std::int64_t utime) const;
    Read read();
    void on_status(const messages::RawMessage& message);
    bool next(ReadResult& result);
    std::string end_source();
    bool jumps() const;
    void count(const ReadResult& result);
    void show_trouble(const ReadResult& result);
    void complain(const std::string& what, const ReadResult& result);

    messages::Bus& bus_;
    std::shared_ptr<FrameSource> source_;
    SensorShellOptions options_;
    PositionFile position_;
    std::optional<std::int64_t> played_until_;  ///< stamp of the last frame of the process before
    std::unique_ptr<ReadAhead> ahead_;          ///< only live
    messages::ModuleStatus status_{"sensor"};
    std::optional<std::uint64_t> sender_;  ///< tells this sender from another; none in one process, where a
                                           ///< run gives the same bytes again
    SensorFrame frame_;
    bool pending_ = false, ended_ = false;
    std::int64_t played_utime_ = 0;  ///< of the last frame published, as the source has it
    std::int64_t frames_ = 0, broken_ = 0, colorless_ = 0, ends_missing_ = 0;
    std::int64_t start_wall_us_ = 0, start_utime_ = 0, start_frame_ = 0, last_utime_ = 0;
    std::int64_t last_camera_utime_ = 0, last_camera_wall_us_ = 0;
    std::int64_t disconnected_us_ = 0;  ///< since when the bus has no connection; 0: it has
    std::int32_t camera_seq_ = 0;
    std::map<std::string, std::int64_t> camera_losses_;
    std::string trouble_;      ///< of a live camera, now
    std::string first_fault_;  ///< of a frame that could not be used
};

/// A frame's images as they are sent, without what tells one message from another (number, sender).
bot_core::images_t images_of(const SensorFrame& frame, const CameraInfo& camera,
                             const SensorShellOptions& options);

/// rate and speed. Refers to `options`, which must outlive it.
OptionList pacing_of(SensorShellOptions& options);
/// color, depth and jpeg_quality. Refers to `options`, which must outlive it.
OptionList encoding_of(SensorShellOptions& options);

}  // namespace planemap::sensor
