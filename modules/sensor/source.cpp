// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "camera/cameras.hpp"
#include "core/validation.hpp"
#include "sensor/corrected_source.hpp"
#include "sensor/dataset.hpp"
#include "sensor/log_source.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::sensor {

namespace {

using Source = std::unique_ptr<FrameSource>;

bool is_simulator(const std::string& input) {
    return input.starts_with("sim:");
}

bool is_file(const std::string& input) {
    std::error_code ignored;
    return std::filesystem::exists(input, ignored) && !std::filesystem::is_directory(input, ignored);
}

Source open_simulator(const std::string& input, const SourceOptions& options) {
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(input));
    if (options.camera) {
        CameraInfo own = source->camera();
        own.depth_correction = options.camera->depth_correction;
        if (!own.depth_correction || !(own.depth == options.camera->depth))
            throw std::invalid_argument(
                input +
                ": the simulator has a camera of its own; of --camera it takes only the depth_correction of "
                "one with the same depth_camera");
        source->select(options.frames);
        return std::make_unique<CorrectedSource>(std::move(source), own);
    }
    source->select(options.frames);
    return source;
}

Source open_log(const std::string& input, const SourceOptions& options) {
    return std::make_unique<LogSource>(input, options);
}

Source open_folder(const std::string& input, const SourceOptions& options) {
    return std::make_unique<Dataset>(input, options);
}

[[noreturn]] void refuse_duration(const std::string& input) {
    throw std::invalid_argument("--duration is for a live camera; " + input + " is none");
}

/// A part of a source that can only be read in order.
class SelectedFrames : public SourceAround {
  public:
    SelectedFrames(std::unique_ptr<FrameSource> all, const FrameRange& range)
        : SourceAround(std::move(all)), range_(range) {
        if (const auto size = source().size()) frames_within(range_, *size);  // throws if there are none
    }

    std::optional<std::size_t> size() const override {
        const auto size = source().size();
        if (!size) return std::nullopt;
        const auto [from, to] = frames_within(range_, *size);
        return to - from;
    }
    std::optional<double> progress() const override { return std::nullopt; }  // the source's is of all frames
    ReadResult next(SensorFrame& frame) override {
        for (;;) {
            if (range_.to && next_ >= *range_.to) {
                frame = {};
                return {.status = ReadResult::Status::kEnd, .message = {}};
            }
            ReadResult result = source().next(frame);
            using Status = ReadResult::Status;
            if (result.status == Status::kEnd || result.status == Status::kNothing) return result;
            if (next_++ >= range_.from) return result;
        }
    }

  private:
    FrameRange range_;
    std::size_t next_ = 0;  ///< number of the next frame
};

/// A live camera for a while.
class TimedFrames : public SourceAround {
  public:
    TimedFrames(std::unique_ptr<FrameSource> camera, double duration_s)
        : SourceAround(std::move(camera)),
          end_(Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(duration_s))) {}

    std::optional<std::size_t> size() const override { return std::nullopt; }
    std::optional<double> progress() const override { return std::nullopt; }
    bool is_live() const override { return true; }
    ReadResult next(SensorFrame& frame) override {
        if (Clock::now() < end_) return source().next(frame);
        frame = {};
        return {.status = ReadResult::Status::kEnd, .message = {}};
    }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point end_;
};

Source open_camera(const std::string& input, const SourceOptions& options) {
    camera::CameraRequest request = options.device;
    request.described = options.camera;
    Source source = camera::open_camera(input, request);
    if (options.duration_s > 0 && !source->is_live()) refuse_duration(input);
    if (options.duration_s > 0) source = std::make_unique<TimedFrames>(std::move(source), options.duration_s);
    if (!options.frames.is_all())
        source = std::make_unique<SelectedFrames>(std::move(source), options.frames);
    return source;
}

/// One row a kind of input. The first that `is` so is opened; the last takes what is left.
struct Opener {
    InputKind kind;
    bool (*is)(const std::string& input);
    Source (*open)(const std::string& input, const SourceOptions& options);
};
constexpr Opener kOpeners[] = {
    {InputKind::kCamera, camera::is_camera, open_camera},
    {InputKind::kSimulator, is_simulator, open_simulator},
    {InputKind::kLog, is_file, open_log},
    {InputKind::kFolder, [](const std::string&) { return true; }, open_folder},
};

const Opener& opener_of(const std::string& input) {
    return *std::find_if(std::begin(kOpeners), std::end(kOpeners),
                         [&](const Opener& opener) { return opener.is(input); });
}

}  // namespace

void SourceOptions::validate() const {
    FieldErrors errors("source options");
    errors.require(std::isfinite(max_color_gap_s) && max_color_gap_s >= 0, "max_color_gap_s", max_color_gap_s,
                   "finite and at least 0");
    errors.require(std::isfinite(duration_s) && duration_s >= 0, "duration", duration_s,
                   "finite and at least 0");
    errors.throw_if_any();
}

InputKind kind_of_input(const std::string& input) {
    return opener_of(input).kind;
}

std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options) {
    options.validate();
    const Opener& opener = opener_of(input);
    if (!options.channel.empty() && opener.kind != InputKind::kLog)
        throw std::invalid_argument(input + ": has no channels; --channel is for LCM logs");
    if (opener.kind != InputKind::kCamera) {
        if (options.duration_s > 0) refuse_duration(input);
        if (!options.device.record.empty()) camera::refuse_recording(input);
        if (options.device.repeat)
            throw std::invalid_argument("--repeat is for .oni files; INPUT is " + input);
    }
    Source source = opener.open(input, options);
    const CameraInfo camera = source->camera();
    if (!camera.depth_correction) return source;
    return std::make_unique<CorrectedSource>(std::move(source), camera);
}

}  // namespace planemap::sensor
