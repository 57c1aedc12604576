// SPDX-License-Identifier: BSD-3-Clause
#include "run/growth.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "messages/convert.hpp"
#include "pipeline/pipeline.hpp"
#include "run/report_text.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;
using Moment = Growth::Moment;

/// Milliseconds a frame from the moment before, whose figures are 0 for the first.
double per_frame(const Moment& before, const Moment& now, double Moment::*ms) {
    return (now.*ms - before.*ms) /
           static_cast<double>(std::max<std::int64_t>(now.frames - before.frames, 1));
}

std::string kilobytes(const Json& bytes) {
    return format("%.1f", bytes.get<double>() / 1000);
}

}  // namespace

namespace {

/// What a frame costs, without sizes. Precondition: there was one.
Moment moment_of(pipeline::Pipeline& pipeline) {
    const auto cpu_ms = [](messages::Shell& shell) { return shell.status().work_cpu_ms().sum(); };
    Moment moment;
    moment.utime = pipeline.latest()->utime;
    moment.frames = static_cast<std::int64_t>(pipeline.estimates().size());
    moment.segmentation_ms = cpu_ms(pipeline.segmentation());
    moment.map_ms = cpu_ms(pipeline.map());
    return moment;
}

void take_sizes(pipeline::Pipeline& pipeline, Moment& moment) {
    const PlaneMap& map = pipeline.map().mapper().map();
    moment.planes = map.planes.size();
    moment.map_bytes = static_cast<std::size_t>(messages::to_message(map, 0).getEncodedSize());
}

/// Fills in the OctoMap's growth: a moment has the depth of the keyframes until then. False if it is not
/// known.
bool take_octomap(pipeline::Pipeline& pipeline, std::vector<Moment>& moments) {
    if (pipeline.octomap() == nullptr) return false;
    std::map<int, std::int64_t> utimes;
    for (const KeyframePose& keyframe : pipeline.keyframes().keyframes) utimes[keyframe.id] = keyframe.utime;
    double spent_ms = 0, since_ms = messages::thread_cpu_ms();
    auto next = moments.begin();
    const auto fill_in = [&](std::int64_t before_us, const ::octomap::OcTree& tree) {
        spent_ms += messages::thread_cpu_ms() - since_ms;
        if (next != moments.end() && next->utime < before_us) {
            const octomap::OctomapSizes sizes = octomap::sizes_of(tree);
            for (; next != moments.end() && next->utime < before_us; ++next) {
                next->octomap_nodes = sizes.bt_nodes;
                next->octomap_bytes = sizes.bt_bytes;
                next->octomap_occupied_bytes = sizes.bt_occupied_bytes;
                next->octomap_ms = spent_ms;
            }
        }
        since_ms = messages::thread_cpu_ms();
    };
    const auto tree =
        pipeline.octomap()->builder().grown([&](octomap::ScanId id, const ::octomap::OcTree& so_far) {
            const auto keyframe =
                utimes.find(id.keyframe);  // none: it went for another one, at about its time
            fill_in(keyframe != utimes.end() ? keyframe->second : 0, so_far);
        });
    if (tree) fill_in(std::numeric_limits<std::int64_t>::max(), *tree);
    return tree != nullptr;
}

}  // namespace

void Growth::watch(pipeline::Pipeline& pipeline) {
    const auto frames = static_cast<std::int64_t>(pipeline.estimates().size());
    if (frames == (last_ ? last_->frames : 0)) return;
    last_ = moment_of(pipeline);
    if (!samples_.wants_next()) return;
    Moment moment = *last_;
    take_sizes(pipeline, moment);
    samples_.add(moment);
}

void Growth::finish(pipeline::Pipeline& pipeline) {
    if (pipeline.estimates().empty()) return;
    moments_ = samples_.kept();
    Moment end = moment_of(pipeline);
    if (last_) {
        end.segmentation_ms = last_->segmentation_ms;
        end.map_ms = last_->map_ms;
    }
    take_sizes(pipeline, end);
    if (!moments_.empty() && moments_.back().frames == end.frames) moments_.pop_back();
    moments_.push_back(end);
    has_octomap_ = take_octomap(pipeline, moments_);
}

Json Growth::figures() const {
    return growth_figures(moments_, has_octomap_);
}

Json growth_figures(const std::vector<Moment>& moments, bool has_octomap) {
    Json figures;
    for (const char* key :
         {"time_s", "planes", "map_bytes", "octomap_nodes", "octomap_bytes", "octomap_occupied_bytes",
          "planes_ms_per_frame", "segmentation_ms_per_frame", "octomap_ms_per_frame"})
        figures[key] = Json::array();
    Moment before;
    for (const Moment& now : moments) {
        const double segmentation_ms = per_frame(before, now, &Moment::segmentation_ms);
        const std::int64_t since_ms = (now.utime - moments.front().utime) / 1000;
        figures["time_s"].push_back(static_cast<double>(since_ms) / 1000);
        figures["planes"].push_back(now.planes);
        figures["map_bytes"].push_back(now.map_bytes);
        figures["octomap_nodes"].push_back(now.octomap_nodes);
        figures["octomap_bytes"].push_back(now.octomap_bytes);
        figures["octomap_occupied_bytes"].push_back(now.octomap_occupied_bytes);
        figures["planes_ms_per_frame"].push_back(segmentation_ms + per_frame(before, now, &Moment::map_ms));
        figures["segmentation_ms_per_frame"].push_back(segmentation_ms);
        figures["octomap_ms_per_frame"].push_back(per_frame(before, now, &Moment::octomap_ms));
        before = now;
    }
    if (!has_octomap)
        for (const char* key :
             {"octomap_nodes", "octomap_bytes", "octomap_occupied_bytes", "octomap_ms_per_frame"})
            figures[key] = nullptr;
    return figures;
}

std::string growth_markdown(const Json& report) {
    constexpr std::size_t kRows = 5;
    const Json growth = report.value("growth", Json());
    if (!growth.is_object() || growth.at("time_s").empty()) return "";
    const std::size_t count = growth.at("time_s").size();
    const bool has_octomap = growth.at("octomap_bytes").is_array();
    std::string out = std::string("\n## Growth\n\n| after s | planes | message kB |") +
                      (has_octomap ? " OctoMap nodes | .bt kB |\n| ---: | ---: | ---: | ---: | ---: |\n"
                                   : "\n| ---: | ---: | ---: |\n");
    std::size_t last = count;
    for (std::size_t i = 1; i <= kRows; ++i) {
        const std::size_t at = std::max<std::size_t>(i * count / kRows, 1) - 1;
        if (at == last) continue;
        last = at;
        out += "| " + format("%.1f", growth.at("time_s")[at].get<double>()) + " | " +
               growth.at("planes")[at].dump() + " | " + kilobytes(growth.at("map_bytes")[at]) + " |";
        if (has_octomap)
            out += " " + growth.at("octomap_nodes")[at].dump() + " | " +
                   kilobytes(growth.at("octomap_bytes")[at]) + " |";
        out += "\n";
    }
    return out + "\nAll samples, and the CPU time a frame, are in report.json.\n";
}

}  // namespace planemap
