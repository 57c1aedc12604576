// SPDX-License-Identifier: BSD-3-Clause
#include "run/stages.hpp"

#include "pipeline/pipeline.hpp"
#include "run/input.hpp"
#include "run/report_text.hpp"

namespace planemap {

using Json = nlohmann::ordered_json;

Json stage_figures(const Histogram& ms, const Histogram& cpu_ms, const std::string& part_of) {
    Json figures{{"median", ms.median()},
                 {"p95", ms.p95()},
                 {"count", ms.count()},
                 {"total_s", ms.sum() / 1000},
                 {"cpu_median", cpu_ms.median()},
                 {"cpu_p95", cpu_ms.p95()},
                 {"cpu_total_s", cpu_ms.sum() / 1000}};
    if (!part_of.empty()) figures["part_of"] = part_of;
    return figures;
}

Json stages_of(const Input& input, pipeline::Pipeline& pipeline) {
    const auto of_module = [](auto* module) {
        return module != nullptr ? stage_figures(module->status().work_ms(), module->status().work_cpu_ms())
                                 : stage_figures({}, {});
    };
    const messages::DecodeTimes& decoding = pipeline.decoder().times();
    const Json all_input = stage_figures(input.read_ms(), input.read_cpu_ms(), "input");
    const Json none = stage_figures({}, {}, "input");
    return {{"input", stage_figures(input.read_ms(), input.read_cpu_ms())},
            {"reading", input.is_simulated() ? none : all_input},
            {"simulation", input.is_simulated() ? all_input : none},
            {"decode", stage_figures(decoding.decode_ms, decoding.decode_cpu_ms)},
            {"registration", stage_figures(decoding.registration_ms, decoding.registration_cpu_ms, "decode")},
            {"segmentation", of_module(&pipeline.segmentation())},
            {"odometry", of_module(&pipeline.odometry())},
            {"graph", of_module(pipeline.graph())},
            {"map", of_module(&pipeline.map())},
            {"octomap", of_module(pipeline.octomap())}};
}

Json StageTimer::figures() const {
    Histogram ms, cpu_ms;
    ms.add(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
    cpu_ms.add(messages::thread_cpu_ms() - cpu_start_ms_);
    return stage_figures(ms, cpu_ms);
}

std::string stages_markdown(const Json& report) {
    std::string out =
        "\n## Time\n\n| stage | median ms | p95 ms | CPU median ms | CPU p95 ms | times | CPU s in all |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for (const auto& item : report.at("stages_ms").items()) {
        const std::string& stage = item.key();
        const Json& figures = item.value();
        const double count = figures.at("count").get<double>();
        const bool is_known = count > 0;
        const auto cell = [&](const char* key, const char* pattern) {
            // CPU times: not in a report of before.
            const Json value = figures.value(key, Json());
            return is_known && value.is_number() ? format(pattern, value.get<double>()) : std::string("-");
        };
        if (is_known) {
            figures.at("median").get<double>();  // a report without it is none
            figures.at("p95").get<double>();
        }
        const std::string part_of = figures.value("part_of", "");
        out += "| " + stage + (part_of.empty() ? "" : " (in " + part_of + ")");
        for (const char* key : {"median", "p95", "cpu_median", "cpu_p95"}) out += " | " + cell(key, "%.2f");
        out += " | " + format("%.0f", count) + " | " + cell("cpu_total_s", "%.2f") + " |\n";
    }
    return out + "\nWall " + format("%.1f s", report.at("wall_s").get<double>()) + ", CPU " +
           format("%.1f s", report.at("cpu_s").get<double>()) + ", peak memory " +
           format("%.0f MB", report.at("peak_rss_mb").get<double>()) +
           " until the maps were whole; sizes and report come after that.\n";
}

}  // namespace planemap
