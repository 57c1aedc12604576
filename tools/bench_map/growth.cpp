// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/growth.hpp"

#include "benchmark/rounds.hpp"
#include "messages/convert.hpp"
#include "run/input.hpp"

namespace planemap::bench_map {

using results::figure;

namespace {

constexpr std::int64_t kEvery = 1000;  // frames a line

/// CPU time of all modules so far.
double pipeline_ms(pipeline::Pipeline& pipeline) {
    return pipeline.decoder().decode_ms().sum() + pipeline.segmentation().status().work_cpu_ms().sum() +
           pipeline.odometry().status().work_cpu_ms().sum() + pipeline.graph()->status().work_cpu_ms().sum() +
           pipeline.map().status().work_cpu_ms().sum();
}

Json point_at(std::int64_t frames, pipeline::Pipeline& pipeline) {
    const map::PlaneMapper& mapper = pipeline.map().mapper();
    return {{"frames", frames},
            {"keyframes", pipeline.keyframes().keyframes.size()},
            {"planes", mapper.map().planes.size()},
            {"message_bytes", messages::to_message(mapper.map(), 0).getEncodedSize()},
            {"memory_bytes", mapper.memory_bytes()}};
}

/// Watches a pipeline as its frames come.
class Observer {
  public:
    Observer(std::int64_t round, Growth& growth) : round_(round), growth_(growth) {}

    void see(std::int64_t frames, pipeline::Pipeline& pipeline) {
        const double total_ms = pipeline.map().status().work_cpu_ms().sum();
        const auto updates = pipeline.map().status().work_cpu_ms().count();
        if (updates > updates_) map_ms_.add((total_ms - map_total_ms_) / double(updates - updates_));
        updates_ = updates;
        map_total_ms_ = total_ms;
        if (frames > 0 && frames % round_ == 0) growth_.rounds.push_back(point_at(frames, pipeline));
        if (frames > 0 && frames % kEvery == 0) note(frames, pipeline);
    }
    void note(std::int64_t frames, pipeline::Pipeline& pipeline) {
        if (frames == frames_) return;
        Json point = point_at(frames, pipeline);
        const double total_ms = pipeline_ms(pipeline);
        point["map_ms"] = map_ms_.median();
        point["frame_ms"] = (total_ms - total_ms_) / static_cast<double>(frames - frames_);
        growth_.points.push_back(std::move(point));
        map_ms_ = {};
        frames_ = frames;
        total_ms_ = total_ms;
    }

  private:
    std::int64_t round_, frames_ = 0, updates_ = 0;
    double map_total_ms_ = 0, total_ms_ = 0;
    Histogram map_ms_;
    Growth& growth_;
};

}  // namespace

std::optional<double> Growth::second_round() const {
    if (rounds.size() < 2) return std::nullopt;
    return figure(rounds[1], "message_bytes") / figure(rounds[0], "message_bytes") - 1;
}

std::optional<double> Growth::cost_ratio() const {
    if (points.size() < 3) return std::nullopt;
    return figure(points.back(), "frame_ms") / figure(points[1], "frame_ms");
}

Growth measure_growth(const std::string& simulator_name, std::int64_t frames,
                      pipeline::PipelineOptions options, const std::function<void(std::int64_t)>& on_frame) {
    Growth growth;
    Observer observer(benchmark::frames_a_round(simulator_name), growth);
    options.with_octomap = false;
    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, options);
    const std::unique_ptr<Input> input = open_input(simulator_name, bus, {.camera = options.camera});
    feed_all(*input, frames, [&](std::int64_t so_far) {
        pipeline.settle();
        observer.see(so_far, pipeline);
        on_frame(so_far);
    });
    pipeline.finish();
    observer.note(input->frames(), pipeline);
    return growth;
}

Json to_json(const std::string& sequence, const Growth& growth) {
    const auto itself = [](double value) { return value; };
    Json json{{"sequence", sequence}, {"points", growth.points}};
    json["second_round_share"] = results::known(growth.second_round(), itself);
    json["cost_ratio"] = results::known(growth.cost_ratio(), itself);
    return json;
}

std::string growth_table(const Growth& growth) {
    using results::text;
    const results::Table table{{"frames", "frames", 6},
                               {"keyframes", "keyframes", 10},
                               {"planes", "planes", 6},
                               {"message B", "message_bytes", 10},
                               {"memory B", "memory_bytes", 10},
                               {"map ms/keyframe", "map_ms", 16, 2},
                               {"all ms/frame", "frame_ms", 13, 2}};
    std::string lines = table.heading();
    for (const Json& point : growth.points) lines += table.line(point);
    for (std::size_t i = 0; i < growth.rounds.size(); ++i) {
        const Json& round = growth.rounds[i];
        lines += text("round %zu ends at frame %.0f: %.0f planes, %.0f bytes\n", i + 1,
                      figure(round, "frames"), figure(round, "planes"), figure(round, "message_bytes"));
    }
    if (const auto added = growth.second_round())
        lines += text("the second round adds %.1f %% to the message\n", 100 * *added);
    if (const auto ratio = growth.cost_ratio())
        lines += text("a frame of the last thousand costs %.2f times one of the second\n", *ratio);
    return lines;
}

}  // namespace planemap::bench_map
