// SPDX-License-Identifier: BSD-3-Clause
#include "bench_soak/soak.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "benchmark/rounds.hpp"
#include "core/processor_time.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/log.hpp"
#include "simulate/recording.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::bench_soak {

namespace {

constexpr double kHalfHour_s = 1800;
constexpr std::int64_t kStartUtime = 1500000000000000;

double cpu_ms() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * processor_seconds(usage);
}

/// Memory of the process that is in use now; its peak would hide what comes back.
double rss_mb() {
    std::ifstream statm("/proc/self/statm");
    double size = 0, resident = 0;
    if (!(statm >> size >> resident)) throw std::runtime_error("/proc/self/statm: cannot be read");
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// What the process has allocated and not freed; the rest of its memory is code, and holes in the heap.
double heap_mb() {
    const struct mallinfo2 info = ::mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

/// The events of a round, over and over, with stamps that go on.
class Feed {
  public:
    Feed(const Round& round, double period_s)
        : round_(round), period_us_(std::llround(1e6 * period_s)), log_(std::in_place, round.log) {}

    /// Publishes up to and including the next frame; returns its index in the round.
    std::size_t next(messages::Bus& bus) {
        messages::LogEvent event;
        for (;;) {
            if (!log_->next(event)) {
                log_.emplace(round_.log);
                at_ = 0;
                continue;
            }
            if (event.channel == messages::channels::kFrame) break;
            bus.publish_bytes(event.channel, event.bytes);
        }
        auto images = messages::decode<bot_core::images_t>(event.bytes);
        const std::int64_t later = kStartUtime + frames_ * period_us_ - images.utime;
        images.utime += later;
        for (bot_core::image_t& image : images.images) {
            image.utime += later;
            image.metadata.clear();
            messages::set_seq(image, static_cast<std::uint32_t>(frames_));
        }
        ++frames_;
        bus.publish(messages::channels::kFrame, images);
        return at_++;
    }

  private:
    const Round& round_;
    std::int64_t period_us_;
    std::optional<messages::LogReader> log_;
    std::int64_t frames_ = 0;
    std::size_t at_ = 0;
};

/// Counts what happens between two points.
class Observer {
  public:
    Observer(const Round& round, pipeline::Pipeline& pipeline) : round_(round), pipeline_(pipeline) {}

    void keyframe() { ++keyframes_; }
    void see(std::size_t frame) {
        ++frames_;
        const OdometryEstimate* estimate = pipeline_.latest();
        if (estimate == nullptr || !is_tracked(estimate->status)) {
            ++lost_;
            return;
        }
        const KeyframeTrajectory& keyframes = pipeline_.keyframes();
        const Pose world_from_camera = keyframes.world_from_odom * estimate->odom_from_camera;
        // The world is the first camera's frame.
        const Pose truth = round_.world_from_camera.front().inverse() * round_.world_from_camera.at(frame);
        off_m_ = std::max(off_m_, (world_from_camera.translation() - truth.translation()).norm());
    }
    Json point() {
        const graph::PoseGraph& graph = pipeline_.graph()->graph();
        const map::PlaneMapper& mapper = pipeline_.map().mapper();
        const double now_ms = cpu_ms(),
                     frames = static_cast<double>(std::max<std::int64_t>(frames_ - last_, 1));
        Json point = {{"frames", frames_},
                      {"lost", lost_},
                      {"keyframes_made", keyframes_},
                      {"keyframes_graph", graph.trajectory().keyframes.size()},
                      {"keyframes_map", mapper.keyframes()},
                      {"loop_closures", graph.trajectory().loop_closures},
                      {"planes", mapper.map().planes.size()},
                      {"rss_mb", rss_mb()},
                      {"heap_mb", heap_mb()},
                      {"graph_mb", static_cast<double>(graph.memory_bytes()) / 1e6},
                      {"map_mb", static_cast<double>(mapper.working_bytes() + mapper.memory_bytes()) / 1e6},
                      {"cpu_ms", (now_ms - last_ms_) / frames},
                      {"off_m", off_m_}};
        last_ms_ = now_ms;
        last_ = frames_;
        off_m_ = 0;
        return point;
    }

  private:
    const Round& round_;
    pipeline::Pipeline& pipeline_;
    std::int64_t frames_ = 0, lost_ = 0, keyframes_ = 0, last_ = 0;
    double last_ms_ = cpu_ms(), off_m_ = 0;
};

}  // namespace

Round render_round(const std::string& simulator_name, const std::filesystem::path& folder) {
    simulator::SimulatorOptions options = simulator::parse_simulator_name(simulator_name);
    options.frames = static_cast<int>(benchmark::frames_a_round(simulator_name));
    auto source = std::make_unique<simulator::SimulatedSource>(options);
    Round round{folder / "round.lcmlog", {}};
    for (int i = 0; i < options.frames; ++i)
        round.world_from_camera.push_back(
            source->world_from_color(source->color_utime(static_cast<std::size_t>(i))));
    std::filesystem::create_directories(folder);
    record(std::move(source), 0, round.log, [](std::int64_t) {});
    return round;
}

std::vector<Json> soak(const Round& round, const SoakOptions& options,
                       const std::function<void(std::int64_t)>& on_frame,
                       const std::function<bool(const Json&)>& on_point) {
    if (options.frames < 1 || options.every < 1 || !(options.period_s >= 0.001 && options.period_s <= 3600))
        throw std::invalid_argument("frames and every must be at least 1, the period 0.001 to 3600 s");
    pipeline::PipelineOptions pipeline_options = options.pipeline;
    pipeline_options.keep_estimates = false;
    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, pipeline_options);
    Observer observer(round, pipeline);
    bus.subscribe(messages::channels::kKeyframe, [&](const messages::RawMessage&) { observer.keyframe(); });
    Feed feed(round, options.period_s);
    std::vector<Json> points;
    for (int frames = 1; frames <= options.frames; ++frames) {
        const std::size_t frame = feed.next(bus);
        pipeline.settle();
        observer.see(frame);
        on_frame(frames);
        if (frames % options.every != 0 && frames != options.frames) continue;
        points.push_back(observer.point());
        if (!on_point(points.back())) break;
    }
    return points;
}

std::optional<double> growth(const std::vector<Json>& points, double period_s) {
    const auto half_hour = std::find_if(points.begin(), points.end(), [&](const Json& point) {
        return results::figure(point, "frames") * period_s >= kHalfHour_s;
    });
    if (half_hour == points.end() || half_hour + 1 == points.end()) return std::nullopt;
    return results::figure(points.back(), "rss_mb") / results::figure(*half_hour, "rss_mb") - 1;
}

Json to_json(const std::string& sequence, const std::vector<Json>& points, double period_s) {
    Json json{{"sequence", sequence}, {"period_s", period_s}, {"points", points}};
    json["memory_growth"] = results::known(growth(points, period_s), [](double share) { return share; });
    return json;
}

const results::Table& table() {
    using results::kBar;
    static const results::Table kTable{{"frames", "frames", 8},
                                       {"lost", "lost", 6},
                                       kBar,
                                       {"keyframes", "keyframes_made", 9},
                                       {"graph", "keyframes_graph", 8},
                                       {"map", "keyframes_map", 6},
                                       {"closures", "loop_closures", 9},
                                       {"planes", "planes", 6},
                                       kBar,
                                       {"RSS MB", "rss_mb", 7, 1},
                                       {"heap MB", "heap_mb", 7, 2},
                                       {"graph MB", "graph_mb", 8, 2},
                                       {"map MB", "map_mb", 7, 2},
                                       kBar,
                                       {"CPU ms", "cpu_ms", 6, 2},
                                       {"off m", "off_m", 7, 4}};
    return kTable;
}

}  // namespace planemap::bench_soak
