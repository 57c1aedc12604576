// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <OpenNI.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "camera/oni_file.hpp"

namespace planemap::camera {

/// What the streams of a camera send, written to an .oni file, beside its place until it is whole. OpenNI2's
/// recorder says nothing of a write that failed; so the file is watched. A recording ends, and nothing else,
/// while there is room to close it, or when nothing more of it is written.
class OniRecording {
  public:
    /// Records these streams, which must outlive it; `color` is null without one. Throws std::runtime_error,
    /// one line, if the file is there already or cannot be begun.
    OniRecording(std::filesystem::path file, openni::VideoStream& depth, openni::VideoStream* color);
    ~OniRecording() { end(); }
    OniRecording(const OniRecording&) = delete;
    OniRecording& operator=(const OniRecording&) = delete;

    /// To be called with each frame: looks at the file, four times a second, and ends the recording if it
    /// must.
    void watch();
    /// Closes the file and puts it in place.
    void end();
    bool is_running() const { return recorder_.isValid(); }
    const std::filesystem::path& file() const { return file_; }
    /// Why it ended before end(), or is not in place; one line. Empty: all is well.
    const std::string& fault() const { return fault_; }

  private:
    using Clock = std::chrono::steady_clock;

    std::string trouble();
    void close(const std::string& why);

    std::filesystem::path file_, beside_;  ///< what it will be named, and what it is meanwhile
    OniWalk walk_;                         ///< of what is written
    Clock::time_point looked_ = Clock::now(), grew_ = Clock::now();
    openni::Recorder recorder_;
    std::string fault_;
};

}  // namespace planemap::camera
