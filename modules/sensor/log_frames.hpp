// SPDX-License-Identifier: BSD-3-Clause
// The camera's part of an LCM log, whoever wrote it: frames as bot_core.images_t, and what describes the
// camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/frame_range.hpp"
#include "messages/log.hpp"
#include "messages/log_contents.hpp"

namespace planemap::sensor {

struct LogFramesOptions {
    std::string channel;           ///< of the frames; empty: the first one that has depth
    bool camera_is_given = false;  ///< the log's own descriptions of the camera are not looked at
    std::string motion_channel{};  ///< whose bot_core.pose_t next() gives, too; empty: none
    FrameRange frames{};           ///< those that next() gives
};

/// Reads the frames of one channel of an LCM log: bot_core.images_t as they are, kinect.frame_msg_t (older
/// logs of a Kinect v1) as the images_t that they are worth.
class LogFrames {
  public:
    /// What next() found.
    enum class Found {
        kFrame,         ///< the event is an images_t
        kBroken,        ///< a frame that is none; fault() says why
        kCamera,        ///< the event is a camera_info_t on PLANEMAP_CAMERA_INFO
        kAcceleration,  ///< the event is one on PLANEMAP_ACCELERATION
        kMotion,        ///< the event is one on the motion channel
        kEnd,
    };

    /// Looks ahead for the channel and the first description of the camera that can be used. Throws
    /// std::runtime_error, one line that names the file, the reason and the way out, if there is no such
    /// channel, no description and none was given, or no log; std::invalid_argument for a range without a
    /// frame.
    LogFrames(const std::filesystem::path& file, const LogFramesOptions& options);

    /// Throws std::runtime_error naming the file if it cannot be read on.
    Found next(messages::LogEvent& event);
    const std::string& fault() const { return fault_; }

    const std::string& channel() const { return options_.channel; }
    /// The first description, and the message it came in; nothing if one was given.
    const std::optional<CameraInfo>& camera() const { return camera_; }
    const std::vector<std::uint8_t>& camera_bytes() const { return camera_bytes_; }

    /// Part of the file that is read, 0 to 1.
    double progress() const;
    /// What is damaged and what is not read, a line each.
    std::vector<std::string> complaints() const;

  private:
    void look_ahead(const std::filesystem::path& file);
    void look_at_camera(const messages::LogEvent& event);
    [[noreturn]] void fail_without_frames(const std::string& name,
                                          const messages::LogContents& contents) const;
    void require_camera(const std::string& name) const;
    void check_range(const std::filesystem::path& file) const;
    bool convert(messages::LogEvent& event);

    LogFramesOptions options_;
    messages::LogReader log_;
    std::size_t next_ = 0;           ///< number of the next frame in the log
    messages::LogContents unread_;   ///< frames of other channels
    bool channel_is_there_ = false;  ///< the one that was asked for
    std::optional<CameraInfo> camera_;
    std::vector<std::uint8_t> camera_bytes_;
    std::int64_t unusable_cameras_ = 0;
    std::string camera_fault_, fault_;
};

/// What to do with a file that is no LCM log: words to follow a semicolon; empty where nothing is known.
std::string way_out_of(const std::filesystem::path& file);

}  // namespace planemap::sensor
