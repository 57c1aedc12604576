// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "sensor/sensor_shell.hpp"

namespace planemap {

/// Writes at most `max_frames` frames of a sensor on a memq:// bus (0: all there are) to an LCM log, as they
/// would be published. Calls `on_frame` with the frames so far after each, and ends early where
/// stop_requested(); at_end, where given, before the log is closed, for what is published last. Returns the
/// bytes of the messages. Throws std::runtime_error naming the file when it cannot be written; what was
/// written until then is removed. Who must not see half a log gives a name of a workspace, and renames.
std::int64_t record(sensor::SensorShell& sensor, messages::Bus& bus, std::int64_t max_frames,
                    const std::filesystem::path& log,
                    const std::function<void(std::int64_t frames)>& on_frame,
                    const std::function<void()>& at_end = {});

/// The same of a source, as fast as it can be written.
std::int64_t record(std::unique_ptr<FrameSource> source, std::int64_t max_frames,
                    const std::filesystem::path& log,
                    const std::function<void(std::int64_t frames)>& on_frame);

}  // namespace planemap
