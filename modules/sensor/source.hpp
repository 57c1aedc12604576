// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera/options.hpp"
#include "core/camera.hpp"
#include "core/frame_range.hpp"
#include "core/frame_source.hpp"

namespace planemap::sensor {

/// What INPUT may be, for --help of all who take one.
inline constexpr const char* kInputs =
    "openni2[:URI or SERIAL] or freenect for a camera, FILE.oni, an LCM log, a TUM-layout folder (rgb.txt, "
    "depth.txt, camera.json), or sim:WORLD[?KEY=VALUE&...]";

/// Of flags that several programs have, as --help tells them.
inline constexpr const char* kChannelHelp =
    "Of a log: the channel of the frames; default: the first that has depth";
inline constexpr const char* kDurationHelp = "A live camera ends after so many seconds; 0: with Ctrl-C";
inline constexpr const char* kRateHelp = "Frames a second, whatever the timestamps say; 0: as recorded";
inline constexpr const char* kSpeedHelp = "Times the recorded speed; 0: as fast as the frames are taken";

/// How an input is read.
struct SourceOptions {
    double max_color_gap_s = 0.02;       ///< depth without a colour image this near in time has no colour
    FrameRange frames{};                 ///< what next() gives; as if the source had no others
    std::optional<CameraInfo> camera{};  ///< instead of what the input says of its camera
    std::string channel{};               ///< of a log: whose frames; empty: the first that has depth
    std::string motion_channel{};        ///< of a log: what planemap-run plays beside the frames; empty: none
    double duration_s = 0;               ///< a live camera ends then, by the clock; 0: never
    camera::CameraRequest device{};      ///< of a camera or its recording; `described` is `camera` above

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// What an input is.
enum class InputKind {
    kCamera,     ///< a camera or its recording, see camera::is_camera()
    kSimulator,  ///< sim:WORLD?key=value&...; see SimulatedSource
    kLog,        ///< an LCM log, or any other file: LogSource says what is wrong with it
    kFolder,     ///< a folder in the TUM layout, or nothing that is there: Dataset says so
};

/// By the name, and what stands in the file system.
InputKind kind_of_input(const std::string& input);

/// Opens `input`, whatever kind it is of.
/// Throws std::runtime_error naming file and reason if there is nothing to read, and what to do about it;
/// std::invalid_argument for a bad camera.json or simulator name, and for an option that is for inputs of
/// another kind.
std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options = {});

}  // namespace planemap::sensor
