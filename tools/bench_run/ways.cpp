// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run/ways.hpp"

#include <cmath>

#include "bench_run/peers.hpp"
#include "bench_run/program_run.hpp"
#include "benchmark/choices.hpp"
#include "core/files.hpp"

namespace planemap::bench_run {

namespace {

using results::Json;

constexpr char kFolder[] = "folder", kLog[] = "log", kWithOctomap[] = "log+octomap",
               kProcesses[] = "processes";
constexpr int kMostUnitFrames = 200;    // of R
constexpr int kMostOctomapFrames = 60;  // about as many as there are keyframes

/// One sequence: what its rows share.
class Measurement {
  public:
    Measurement(const benchmark::SequenceInfo& sequence, const Bench& bench)
        : name_(sequence.name),
          input_(benchmark::input_of(sequence, bench.data)),
          bench_(bench),
          stem_(bench.scratch / benchmark::file_name_of(sequence.name)),
          unit_(measure_rgbd_plane(input_, bench.frames, kMostUnitFrames)) {}

    std::vector<Json> rows(const std::vector<WayInfo>& ways) {
        std::vector<Json> rows;
        rows.reserve(ways.size() + 2);
        for (const WayInfo& way : ways) rows.push_back(row_of(way.name));
        rows.push_back(peer_row("RgbdPlane/4", unit_));
        if (!trajectory_.empty())
            rows.push_back(peer_row("OctoMap insertion",
                                    measure_octomap(input_, trajectory_, bench_.frames, kMostOctomapFrames)));
        return rows;
    }

  private:
    std::string program(const char* name) const { return (bench_.programs / name).string(); }

    const std::string& log() {
        if (log_.empty()) {
            log_ = stem_.string() + ".lcmlog";
            run_program_to_end({program("planemap-convert"), input_, "--output", log_, "--quiet"});
        }
        return log_;
    }

    Json row_of(const std::string& way) {
        const std::filesystem::path output = stem_.string() + "-" + way;
        const std::string& input = way == kFolder ? input_ : log();
        const bool is_live = way == kProcesses;
        std::vector<std::string> command{program(is_live ? "planemap-launch" : "planemap-run"), input,
                                         "--output", output.string()};
        if (way != kWithOctomap) command.emplace_back("--no-octomap");
        if (!is_live) command.insert(command.end(), {"--quiet", "--threads", std::to_string(bench_.threads)});
        if (!is_live && bench_.frames > 0)
            command.insert(command.end(), {"--frames", "0:" + std::to_string(bench_.frames)});
        const ProgramRun run = run_program_to_end(command);
        const Json report = Json::parse(read_file(output / "report.json"));
        if (!is_live) trajectory_ = output / "trajectory.txt";
        Json row = cost_row(way, report.at(is_live ? "tracked" : "frames").get<std::int64_t>(),
                            1e3 * run.cpu_s, run.peak_rss_mb);
        const Json& wall_s = report.at("wall_s");
        row["frames_per_s"] =
            row["frames"].get<double>() / (wall_s.is_number() ? wall_s.get<double>() : run.wall_s);
        if (const Json& stages = report.at("stages_ms"); stages.is_object())
            row["report_cpu_s"] = stages.at("report").at("cpu_total_s");
        return row;
    }

    Json peer_row(const std::string& what, const Json& peer) const {
        return cost_row(what, peer.at("frames").get<std::int64_t>(), peer.at("total_ms").get<double>(),
                        peer.at("peak_rss_mb").get<double>());
    }

    Json cost_row(const std::string& way, std::int64_t frames, double cpu_ms, double peak_rss_mb) const {
        const double unit_ms = unit_.at("median_ms").get<double>();
        const double each_ms = frames > 0 ? cpu_ms / static_cast<double>(frames) : NAN;
        return {{"sequence", name_},
                {"way", way},
                {"frames", frames},
                {"frames_per_s", nullptr},
                {"cpu_s", cpu_ms / 1e3},
                {"cpu_ms", results::number(each_ms)},
                {"r", results::number(each_ms / unit_ms)},
                {"r_ms", results::number(unit_ms)},
                {"report_cpu_s", nullptr},
                {"peak_rss_mb", peak_rss_mb}};
    }

    std::string name_, input_, log_;
    const Bench& bench_;
    std::filesystem::path stem_, trajectory_;
    Json unit_;
};

}  // namespace

const std::vector<WayInfo>& known_ways() {
    static const std::vector<WayInfo> ways{
        {kFolder, "planemap-run on the input as it is: a folder's images, or the simulator; no OctoMap"},
        {kLog, "planemap-run on a log that planemap-convert made of it; no OctoMap"},
        {kWithOctomap, "the same with the OctoMap to compare with, and its trees in the report"},
        {kProcesses,
         "planemap-launch on the log, at the recorded speed: the modules as processes; no OctoMap"}};
    return ways;
}

std::string described_ways() {
    return benchmark::described(known_ways(), 14);
}

std::vector<Json> rows_of(const benchmark::SequenceInfo& sequence, const std::vector<WayInfo>& ways,
                          const Bench& bench) {
    return Measurement(sequence, bench).rows(ways);
}

results::Table table() {
    return {{"sequence", "sequence", -16},
            {"way", "way", -17},
            results::kBar,
            {"frames", "frames", 6},
            {"frames/s", "frames_per_s", 8, 1},
            {"CPU s", "cpu_s", 7, 1},
            {"report", "report_cpu_s", 6, 1},
            results::kBar,
            {"ms", "cpu_ms", 7, 2},
            {"R", "r", 6, 2},
            {"R ms", "r_ms", 6, 2},
            results::kBar,
            {"MB", "peak_rss_mb", 6, 0}};
}

}  // namespace planemap::bench_run
