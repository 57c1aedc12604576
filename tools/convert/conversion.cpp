// SPDX-License-Identifier: BSD-3-Clause
#include "convert/conversion.hpp"

#include <spdlog/spdlog.h>

#include <bot_core/pose_t.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "camera/fakenect.hpp"
#include "convert/bag_source.hpp"
#include "convert/layout_source.hpp"
#include "convert/shrunk_color.hpp"
#include "convert/tum_folder.hpp"
#include "core/stamp.hpp"
#include "core/standard_output.hpp"
#include "core/validation.hpp"
#include "messages/decode.hpp"
#include "messages/image_codec.hpp"
#include "messages/log.hpp"
#include "messages/log_contents.hpp"
#include "messages/process.hpp"
#include "results/new_file.hpp"
#include "results/progress_line.hpp"
#include "sensor/source.hpp"
#include "sensor/undistorted_source.hpp"
#include "simulate/recording.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::convert {

namespace fs = std::filesystem;

namespace {

bool starts_with(const fs::path& file, std::string_view magic) {
    std::string start(magic.size(), '\0');
    std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
    return start == magic;
}

bool is_bag(const fs::path& file) {
    return starts_with(file, "#ROSBAG V");
}

/// What is not read, by its name or its first bytes, and what to do instead.
void refuse_by_name(const fs::path& input) {
    std::error_code ignored;
    const bool is_folder = fs::is_directory(input, ignored);
    const std::string end = input.extension();
    const auto refuse = [&](const std::string& what) {
        throw std::runtime_error(input.string() + ": " + what);
    };
    if (end == ".db3" || end == ".mcap" || (is_folder && fs::exists(input / "metadata.yaml", ignored)) ||
        starts_with(input, "\x89MCAP") || starts_with(input, "SQLite format 3")) {
        refuse("is a ROS 2 bag, which is not read: `rosbags-convert --src " + input.string() +
               " --dst NAME.bag` (pip install rosbags) makes a ROS 1 bag of it");
    }
    if (end == ".mkv" || starts_with(input, "\x1A\x45\xDF\xA3")) {
        refuse(
            "is an Azure Kinect recording in Matroska, which is not read: Open3D's "
            "azure_kinect_mkv_reader.py makes a "
            "folder with color/, depth/ and intrinsic.json of it, and that is read");
    }
    if (starts_with(input, "#ROSBAG V1"))
        refuse("is a bag of version 1: `rosbag fix` makes one of version 2.0");
}

Trajectory truth_in_log(const fs::path& file) {
    messages::LogReader log(file);
    Trajectory truth;
    for (messages::LogEvent event; log.next(event);) {
        if (event.channel != kTruthChannel || !messages::is_a<bot_core::pose_t>(event.bytes)) continue;
        const auto pose = messages::decode<bot_core::pose_t>(event.bytes);
        const Eigen::Quaterniond q(pose.orientation[0], pose.orientation[1], pose.orientation[2],
                                   pose.orientation[3]);
        if (!(std::abs(q.norm() - 1) < 1e-3) || !Eigen::Vector3d(pose.pos).allFinite()) continue;
        truth.push_back({pose.utime, make_pose(Eigen::Vector3d(pose.pos), q)});
    }
    return truth;
}

bot_core::pose_t pose_message(const StampedPose& stamped) {
    bot_core::pose_t message{};
    message.utime = stamped.utime;
    const Eigen::Vector3d t = stamped.world_from_camera.translation();
    const Eigen::Quaterniond q(stamped.world_from_camera.linear());
    std::copy(t.data(), t.data() + 3, message.pos);
    message.orientation[0] = q.w(), message.orientation[1] = q.x();
    message.orientation[2] = q.y(), message.orientation[3] = q.z();
    return message;
}

/// Says how far it is; false when a signal asks to stop.
class Watch {
  public:
    Watch(const FrameSource& source, bool quiet) : source_(source), line_(quiet) {}
    bool operator()(std::int64_t frames) {
        if (line_.is_due()) {
            const auto size = source_.size();
            const auto share = size && *size > 0
                                   ? std::optional(static_cast<double>(frames) / static_cast<double>(*size))
                                   : source_.progress();
            const double elapsed =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
            const std::string percent =
                share ? ", " + std::to_string(static_cast<int>(100 * *share)) + " %" : "";
            line_.show("frame " + std::to_string(frames) + percent + time_left(share, elapsed));
        }
        return !messages::stop_requested();
    }
    void end() { line_.clear(); }

  private:
    const FrameSource& source_;
    ProgressLine line_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What came over, in one line.
std::string counts_text(const TumFolder& written) {
    std::string text = std::to_string(written.frames) + " frames";
    if (written.broken > 0)
        text += ", " + std::to_string(written.broken) + " left out that could not be read";
    if (written.colorless > 0)
        text += ", " + std::to_string(written.colorless) + " without their colour, which could not be read";
    if (written.repeated > 0)
        text += ", " + std::to_string(written.repeated) + " left out whose stamp was there already";
    return text;
}

TumFolder write_log(std::unique_ptr<FrameSource> source, const Trajectory& truth, const fs::path& output,
                    const ConvertOptions& options) {
    NewFile file(output);
    messages::Bus bus("memq://");
    Watch watch(*source, options.quiet);
    sensor::SensorShell sensor(bus, std::move(source), options.encoding);
    std::size_t next_pose = 0;
    const auto publish_truth = [&](std::int64_t until) {
        for (; next_pose < truth.size() && truth[next_pose].utime <= until; ++next_pose)
            bus.publish(kTruthChannel, pose_message(truth[next_pose]));
    };
    record(
        sensor, bus, 0, file.part(),
        [&](std::int64_t frames) {
            publish_truth(sensor.last_utime());
            bus.drain();
            watch(frames + sensor.broken());
        },
        [&] { publish_truth(kFarthestUtime); });
    watch.end();
    if (messages::stop_requested())
        throw std::runtime_error(output.string() + ": stopped; nothing was written");
    sensor.finish();
    file.put_in_place();
    return {sensor.frames(), sensor.broken(), sensor.colorless(), 0};
}

TumFolder write_folder(FrameSource& source, const Trajectory& truth, const fs::path& output,
                       const ConvertOptions& options) {
    for (const std::string& note : source.notes()) spdlog::warn("{}", note);
    Watch watch(source, options.quiet);
    const TumFolder written = write_tum_folder(source, truth, output, std::ref(watch),
                                               [](const std::string& line) { spdlog::warn("{}", line); });
    watch.end();
    for (const std::string& complaint : source.complaints()) spdlog::warn("{}", complaint);
    return written;
}

/// As a Kinect v1 would have sent it, which cannot say what its lens does.
TumFolder write_kinect(std::unique_ptr<FrameSource> sensed, const fs::path& output) {
    const std::unique_ptr<FrameSource> pinhole = sensor::undistorted(std::move(sensed));
    FrameSource& source = *pinhole;
    const std::size_t frames =
        camera::write_fakenect(source, output, 0, [](const SensorFrame& frame, const PinholeCamera& camera) {
            return frame.color_jpeg.empty()
                       ? frame.color
                       : messages::decode_jpeg_colors(frame.color_jpeg, camera.width, camera.height);
        });
    for (const std::string& complaint : source.complaints()) spdlog::warn("{}", complaint);
    return {static_cast<std::int64_t>(frames), 0, 0, 0};
}

}  // namespace

void ConvertOptions::validate() const {
    FieldErrors errors("planemap-convert");
    errors.require(std::isfinite(max_color_gap_s) && max_color_gap_s >= 0, "color-gap", max_color_gap_s,
                   "finite and at least 0");
    errors.require(rate_hz > 0 && rate_hz <= 1000, "rate", rate_hz, "above 0 and at most 1000 Hz");
    errors.require(depth_units_per_metre >= CameraLimits::kLeastUnits &&
                       depth_units_per_metre <= CameraLimits::kMostUnits,
                   "depth-units", depth_units_per_metre, "100 to 100000 a metre");
    errors.throw_if_any();
}

std::unique_ptr<FrameSource> open_input(const std::string& input, const ConvertOptions& options) {
    refuse_by_name(input);
    if (is_bag(input)) {
        return with_color_small_enough(open_bag(
            input, {options.depth_topic, options.color_topic, options.camera, options.max_color_gap_s}));
    }
    if (!options.depth_topic.empty() || !options.color_topic.empty())
        throw std::invalid_argument(input +
                                    ": has no topics; --depth-topic and --color-topic are for ROS bags");
    if (is_camera_layout(input)) {
        return with_color_small_enough(open_layout(input, {options.camera, options.max_color_gap_s,
                                                           options.rate_hz, options.depth_units_per_metre}));
    }
    return sensor::open_source(
        input,
        {.max_color_gap_s = options.max_color_gap_s, .camera = options.camera, .channel = options.channel});
}

Trajectory truth_of(const std::string& input, const FrameSource& source) {
    if (const auto* simulated = dynamic_cast<const simulator::SimulatedSource*>(&source.origin()))
        return simulated->ground_truth();
    std::error_code ignored;
    fs::path folder = input;
    if (sensor::kind_of_input(input) == sensor::InputKind::kLog && !is_bag(input)) {
        Trajectory truth = truth_in_log(input);
        if (!truth.empty()) return truth;
        folder = folder.parent_path();
    }
    const fs::path file = folder / "groundtruth.txt";
    if (is_bag(input) || !fs::is_regular_file(file, ignored)) return {};
    try {
        std::vector<std::string> notes;
        Trajectory truth = read_trajectory(file, &notes);
        for (const std::string& note : notes) spdlog::warn("{}", note);
        return truth;
    } catch (const std::runtime_error& error) {
        spdlog::warn("{}; it does not come over", error.what());
        return {};
    }
}

void convert(const std::string& input, const fs::path& output, const ConvertOptions& options) {
    options.validate();
    messages::catch_stop_signals();
    const std::string end = output.extension();
    const bool to_log =
        options.to == "log" || (options.to == "auto" && (end == ".lcmlog" || end == ".lcm" || end == ".log"));
    std::unique_ptr<FrameSource> source = open_input(input, options);
    if (options.to == "fakenect") {
        print(output.string() + ": " + counts_text(write_kinect(std::move(source), output)) + "\n");
        return;
    }
    const Trajectory truth = truth_of(input, *source);
    const TumFolder written = to_log ? write_log(std::move(source), truth, output, options)
                                     : write_folder(*source, truth, output, options);
    print(output.string() + ": " + counts_text(written) +
          (truth.empty() ? "" : ", " + std::to_string(truth.size()) + " true poses") + "\n");
}

}  // namespace planemap::convert
