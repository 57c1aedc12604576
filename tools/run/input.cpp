// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "pipeline/preparation.hpp"
#include "sensor/log_frames.hpp"
#include "sensor/sensor_shell.hpp"
#include "sensor/source_ahead.hpp"
#include "simulator/planes_truth.hpp"

namespace planemap {

namespace {

int threads_of(const pipeline::Preparation* preparation) {
    return preparation != nullptr ? preparation->threads() : 1;
}

/// A camera, a folder or the simulator, through the same shell as the sensor process; pixels stay raw, nobody
/// decodes them twice.
class SensorInput : public Input {
  public:
    SensorInput(const std::string& name, messages::Bus& bus, const sensor::SourceOptions& options,
                pipeline::Preparation* preparation)
        : folder_(name), preparation_(preparation), shell_(bus, open(name, options), in_process()) {
        read_truth();
    }

    std::int64_t frames() const override { return shell_.frames() + shell_.broken(); }
    std::optional<double> progress() const override {
        const auto size = shell_.source().size();
        if (!size || *size == 0) return shell_.source().progress();
        return static_cast<double>(frames()) / static_cast<double>(*size);
    }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines = shell_.source().complaints();
        if (shell_.broken() > 0)
            lines.push_back(std::to_string(shell_.broken()) + " frames could not be read");
        if (shell_.colorless() > 0)
            lines.push_back(std::to_string(shell_.colorless()) + " frames without their colour");
        if (shell_.ends_missing() > 0)
            lines.push_back(std::to_string(shell_.ends_missing()) +
                            " frames from files that are cut short behind their last pixel");
        for (const auto& [what, count] : shell_.camera_losses())
            lines.push_back("of the camera: " + std::to_string(count) + " " + what);
        return lines;
    }

    std::optional<Trajectory> truth() const override {
        return simulated() != nullptr ? simulated()->ground_truth() : truth_;
    }
    std::vector<Result> truth_results() const override {
        const simulator::SimulatedSource* simulated = this->simulated();
        if (simulated == nullptr) return {};
        return {
            {"groundtruth.txt", [=](const auto& file) { write_trajectory(file, simulated->ground_truth()); }},
            {"planes_truth.json",
             [=](const auto& file) { simulator::write_planes_truth(file, *simulated); }}};
    }

    bool is_simulated() const override { return simulated() != nullptr; }

  private:
    messages::Spent read_next() override {
        const sensor::SourceAhead::Item& next = ahead_->fetch();
        if (preparation_ != nullptr) preparation_->expect(next.prepared);
        return next.spent;
    }
    bool publish_next() override { return shell_.poll() >= 0; }
    std::unique_ptr<FrameSource> open(const std::string& name, const sensor::SourceOptions& options) {
        std::unique_ptr<FrameSource> source = sensor::open_source(name, options);
        const CameraInfo& camera = source->camera();  // the same for all frames
        auto ahead = std::make_unique<sensor::SourceAhead>(
            std::move(source), threads_of(preparation_),
            [preparation = preparation_, &camera](const SensorFrame& frame, int worker) {
                return preparation->prepare(sensor::images_of(frame, camera, in_process()), worker);
            });
        ahead_ = ahead.get();
        return ahead;
    }
    const simulator::SimulatedSource* simulated() const {
        return dynamic_cast<const simulator::SimulatedSource*>(&shell_.source().origin());
    }
    static sensor::SensorShellOptions in_process() {
        sensor::SensorShellOptions options;
        options.speed = 0;
        options.color = options.depth = "raw";
        return options;
    }
    /// At the start: a bad file is said before the run, and does not take its results away.
    void read_truth() {
        const std::filesystem::path file = folder_ / "groundtruth.txt";
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) return;
        try {
            std::vector<std::string> notes;
            truth_ = read_trajectory(file, &notes);
            for (const std::string& note : notes) spdlog::warn("{}", note);
        } catch (const std::runtime_error& error) {
            spdlog::warn("{}; nothing is compared to it", error.what());
        }
    }

    std::filesystem::path folder_;
    pipeline::Preparation* preparation_;
    sensor::SourceAhead* ahead_ = nullptr;  ///< the shell's
    sensor::SensorShell shell_;
    std::optional<Trajectory> truth_;  ///< of a folder
};

/// What of an LCM log goes on the bus up to and including the next frame.
struct LogPart {
    std::vector<messages::LogEvent> events;  ///< in order; the last is the frame, if there is one
    sensor::LogFrames::Found end = sensor::LogFrames::Found::kEnd;  ///< kFrame, kBroken or kEnd
    std::string fault;                                              ///< of a frame that is broken
    std::string failure;                                            ///< why there is no more
    double progress = 0;
    messages::Spent spent;
    std::shared_ptr<messages::Frame> prepared;
};

/// Where it is published; nullptr: on the channel that it has in the log.
const char* channel_of(sensor::LogFrames::Found found) {
    using Found = sensor::LogFrames::Found;
    if (found == Found::kFrame) return messages::channels::kFrame;
    if (found == Found::kCamera) return messages::channels::kCameraInfo;
    return found == Found::kAcceleration ? messages::channels::kAcceleration : nullptr;
}

/// An LCM log: its frames go on the bus as they came, with the stamps, numbers and senders that they had.
class LogInput : public Input {
  public:
    LogInput(const std::string& name, messages::Bus& bus, const sensor::SourceOptions& options,
             pipeline::Preparation* preparation)
        : bus_(bus),
          preparation_(preparation),
          log_(name, {.channel = options.channel,
                      .camera_is_given = options.camera.has_value(),
                      .motion_channel = options.motion_channel,
                      .frames = options.frames}),
          ahead_(threads_of(preparation), sensor::frames_ahead(threads_of(preparation), false),
                 {[this](LogPart& part) { return read(part); },
                  [this](LogPart& part, int worker) { prepare(part, worker); }}) {
        if (log_.camera()) bus_.publish_bytes(messages::channels::kCameraInfo, log_.camera_bytes());
    }

    std::int64_t frames() const override { return frames_; }
    std::optional<double> progress() const override { return part_.progress; }
    std::vector<std::string> complaints() const override {
        ahead_.stop();
        std::vector<std::string> lines = log_.complaints();
        if (broken_ > 0)
            lines.push_back(std::to_string(broken_) + " frames could not be read; the first: " + fault_);
        return lines;
    }
    std::string failure() const override { return part_.failure; }

  private:
    using Found = sensor::LogFrames::Found;

    bool read(LogPart& part) {
        const messages::SpentTimer timer(part.spent);
        try {
            for (bool is_beside = true; is_beside;) {
                messages::LogEvent event;
                part.end = log_.next(event);
                is_beside =
                    part.end != Found::kFrame && part.end != Found::kBroken && part.end != Found::kEnd;
                if (part.end == Found::kBroken) part.fault = log_.fault();
                if (!is_beside && part.end != Found::kFrame) break;
                if (const char* channel = channel_of(part.end)) event.channel = channel;
                part.events.push_back(std::move(event));
            }
        } catch (const std::runtime_error& error) {  // a disk that fails: what there is so far is kept
            part.end = Found::kEnd;
            part.failure = error.what();
        }
        part.progress = log_.progress();
        return part.end != Found::kEnd;
    }

    void prepare(LogPart& part, int worker) {
        if (part.end != Found::kFrame) return;
        try {
            part.prepared = preparation_->prepare(messages::decode_images(part.events.back().bytes), worker);
        } catch (const messages::MessageError&) {  // told when the message comes
        }
    }

    messages::Spent read_next() override {
        part_.events.clear();
        if (std::optional<LogPart> next = ahead_.take()) part_ = std::move(*next);
        if (preparation_ != nullptr) preparation_->expect(std::move(part_.prepared));
        return part_.spent;
    }

    bool publish_next() override {
        for (const messages::LogEvent& event : part_.events) bus_.publish_bytes(event.channel, event.bytes);
        if (part_.end == Found::kEnd) return false;
        ++frames_;
        if (part_.end == Found::kBroken && ++broken_ == 1) fault_ = part_.fault;
        return true;
    }

    messages::Bus& bus_;
    pipeline::Preparation* preparation_;
    sensor::LogFrames log_;
    std::string fault_;
    std::int64_t frames_ = 0, broken_ = 0;
    LogPart part_;                      ///< that was read last
    mutable WorkAhead<LogPart> ahead_;  ///< last: its threads use what is above
};

}  // namespace

bool Input::feed() {
    messages::Spent spent = read_next();
    bool more = false;
    {
        const messages::SpentTimer timer(spent);
        more = publish_next();
    }
    is_at_end_ = !more;
    if (more) {
        read_ms_.add(spent.ms);
        read_cpu_ms_.add(spent.cpu_ms);
    }
    return more;
}

void feed_all(Input& input, std::int64_t max_frames,
              const std::function<void(std::int64_t frames)>& after_each) {
    while ((max_frames == 0 || input.frames() < max_frames) && input.feed()) after_each(input.frames());
}

std::unique_ptr<Input> open_input(const std::string& name, messages::Bus& bus,
                                  const sensor::SourceOptions& options, pipeline::Preparation* preparation) {
    if (sensor::kind_of_input(name) == sensor::InputKind::kLog)
        return std::make_unique<LogInput>(name, bus, options, preparation);
    return std::make_unique<SensorInput>(name, bus, options, preparation);
}

}  // namespace planemap
