// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "messages/convert.hpp"
#include "messages/process.hpp"
#include "sensor/source.hpp"

namespace planemap {

struct SensorShellOptions {
    double rate_hz = 0;          ///< frames a second whatever the timestamps say; 0: by the timestamps
    double speed = 1;            ///< times the recorded speed; 0: as fast as the consumer takes them
    std::string color = "jpeg";  ///< "jpeg" or "raw": how colour pixels are sent; a stored JPEG goes as it is
    std::string depth = "zipped";  ///< "zipped" or "raw": how depth is sent
    int jpeg_quality = 94;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Publishes a source's frames (OPENNI_FRAME) and its camera (PLANEMAP_CAMERA_INFO at the start and once a
/// second).
class SensorShell : public Shell {
  public:
    SensorShell(Bus& bus, std::unique_ptr<FrameSource> source, SensorShellOptions options);

    ModuleStatus& status() override { return status_; }
    /// Publishes the next frame if it is due; negative at the end of the source.
    int poll() override;

    const FrameSource& source() const { return *source_; }
    std::int64_t frames() const { return frames_; }          ///< published
    std::int64_t broken() const { return broken_; }          ///< skipped: they could not be read
    std::int64_t last_utime() const { return last_utime_; }  ///< of the frame published last
    std::int64_t colorless() const {
        return colorless_;
    }  ///< published without their colour, which could not be read

  private:
    void publish(const SensorFrame& frame);
    void publish_camera(std::int64_t utime);
    bool read();

    Bus& bus_;
    std::unique_ptr<FrameSource> source_;
    SensorShellOptions options_;
    ModuleStatus status_{"sensor"};
    std::optional<std::uint64_t> sender_;  ///< tells this sender from another; none in one process, where a
                                           ///< run gives the same bytes again
    SensorFrame frame_;
    bool pending_ = false;
    std::int64_t frames_ = 0, broken_ = 0, colorless_ = 0;
    std::int64_t start_wall_us_ = 0, start_utime_ = 0, last_utime_ = 0, last_camera_utime_ = 0;
    std::int32_t camera_seq_ = 0;
};

/// --rate, --speed.
void add_pacing_flags(Flags& flags, SensorShellOptions& options);
/// --color, --depth, --jpeg-quality.
void add_encoding_flags(Flags& flags, SensorShellOptions& options);

}  // namespace planemap
