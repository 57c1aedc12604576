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

}  // namespace

Growth::Growth(pipeline::Pipeline& pipeline) : pipeline_(pipeline) {
    listen();
}

/// To the builder that the shell has now: it takes another one for another component.
void Growth::listen() {
    if (pipeline_.octomap() == nullptr) return;
    pipeline_.octomap()->builder().listen(
        [this](octomap::ScanId id, const ::octomap::OcTree& tree, bool is_in) { hear(id, tree, is_in); });
}

void Growth::hear(octomap::ScanId id, const ::octomap::OcTree& tree, bool is_in) {
    if (!is_in) {
        if (last_scan_ && id <= *last_scan_) {
            scans_ = evaluation::Spread<Scan>(kMost);
            spent_ms_ = 0;
        }
        last_scan_ = id;
        since_ms_ = messages::thread_cpu_ms();
        return;
    }
    spent_ms_ += messages::thread_cpu_ms() - since_ms_;
    if (scans_.wants_next()) scans_.add({id.keyframe, octomap::sizes_of(tree), spent_ms_});
}

void Growth::watch() {
    const auto frames = static_cast<std::int64_t>(pipeline_.estimates().size());
    if (frames == (last_ ? last_->frames : 0)) return;
    listen();
    last_ = moment_of(pipeline_);
    if (!samples_.wants_next()) return;
    Moment moment = *last_;
    take_sizes(pipeline_, moment);
    samples_.add(moment);
}

void Growth::finish() {
    if (pipeline_.estimates().empty()) return;
    moments_ = samples_.kept();
    Moment end = moment_of(pipeline_);
    if (last_) {
        end.segmentation_ms = last_->segmentation_ms;
        end.map_ms = last_->map_ms;
    }
    take_sizes(pipeline_, end);
    if (!moments_.empty() && moments_.back().frames == end.frames) moments_.pop_back();
    moments_.push_back(end);
    has_octomap_ = pipeline_.octomap() != nullptr && pipeline_.octomap()->builder().is_growth_heard();
    if (has_octomap_) fill_in_octomap();
}

/// Each moment has the scans of the keyframes until then; the last one all.
void Growth::fill_in_octomap() {
    std::map<int, std::int64_t> utimes;
    for (const KeyframePose& keyframe : pipeline_.keyframes().keyframes) utimes[keyframe.id] = keyframe.utime;
    const auto is_later = [&](const Scan& scan, const Moment& moment) {
        const auto keyframe = utimes.find(scan.keyframe);  // none: it went for another one, at about its time
        return keyframe != utimes.end() && keyframe->second > moment.utime;
    };
    const auto set = [](Moment& moment, const octomap::OctomapSizes& sizes, double ms) {
        moment.octomap_nodes = sizes.bt_nodes;
        moment.octomap_bytes = sizes.bt_bytes;
        moment.octomap_occupied_bytes = sizes.bt_occupied_bytes;
        moment.octomap_ms = ms;
    };
    Scan now;
    auto next = scans_.kept().begin();
    for (Moment& moment : moments_) {
        for (; next != scans_.kept().end() && !is_later(*next, moment); ++next) now = *next;
        set(moment, now.sizes, now.ms);
    }
    set(moments_.back(), pipeline_.octomap()->builder().sizes(), spent_ms_);
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
