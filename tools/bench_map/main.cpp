// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-map: maps beside the true planes.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench_map/growth.hpp"
#include "bench_map/row.hpp"
#include "bench_map/sequences.hpp"
#include "bench_map/true_poses.hpp"
#include "benchmark/build_info.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/data_folder.hpp"
#include "messages/process.hpp"
#include "results/output_file.hpp"

namespace planemap::bench_map {
namespace {

constexpr const char* kProgram = "planemap-bench-map";

struct PosesInfo {
    std::string name, what;
};
const std::vector<PosesInfo>& known_poses() {
    static const std::vector<PosesInfo> kPoses{
        {"estimated", "odometry and graph, as planemap-run"},
        {"true", "the same keyframes where they truly were; inputs with a truth only"},
    };
    return kPoses;
}

struct Arguments {
    std::string sequences = kDefaultSequences, poses = names_of(known_poses());
    std::filesystem::path data = default_data_folder(), json;
    int frames = 0;
    bool growth = false, no_octomap = false, verbose = false, quiet = false;
    PipelineOptions pipeline;
};

std::string description() {
    return "Maps of planes beside the true planes of simulated worlds, and beside the depth of recordings.\n"
           "Examples:\n"
           "  planemap-bench-map --json rows.json                       everything\n"
           "  planemap-bench-map --sequences sim:office --poses true --frames 300 --verbose\n"
           "  planemap-bench-map --sequences sim:building --growth      how a map grows, round after round\n"
           "Sequences: sim:... (see planemap-simulate --help; seed=1..5 is five of them), folders of the "
           "data\n"
           "folder, other folders in TUM's layout, LCM logs. sim:building alone is 10,000 frames.\n"
           "Poses:\n" +
           described(known_poses(), 11) +
           "A true plane is all that lies on one plane and whose visible parts have boxes within 0.5 m of "
           "each\n"
           "other. Its visible surface is what every fifth frame shows within the sensor's range and less "
           "than\n"
           "76 deg from square on. A map plane is on it where it is within 5 cm and 10 deg. For that, a map "
           "of\n"
           "estimated poses is first laid on the truth by its keyframes: a rigid fit of positions and "
           "rotations.\n"
           "Columns:\n"
           "  kf, planes     keyframes in the map, planes of the map\n"
           "  true, found    true planes of more than 0.5 m2; those that one map plane covers by half or "
           "more\n"
           "  split          map planes too many: those of more than 0.5 m2 beyond one on a true plane\n"
           "  spur           spurious: map planes of more than 0.5 m2 of which less than half is on true "
           "ones\n"
           "  dist mm, %     error of the distance between parallel planes (within 5 deg, 0.3 m apart or "
           "more)"
           "\n"
           "                 at the middle of their visible surfaces: mean, median, worst; mean in % (Table "
           "3)\n"
           "  ang deg        error of the angle between other planes that are within 6 m (Table 4)\n"
           "  IoU            map outlines and visible surfaces: common area over united area; the worst "
           "plane's\n"
           "  leaves, area   leaves of an OctoMap at the same poses that planes explain; area of planes "
           "that\n"
           "                 leaves support\n"
           "  msg B, mem B   bytes of the map as a message, and in memory\n"
           "  upd ms, p95    CPU time of the map's update, a keyframe (not the graph's): median, 95th "
           "percentile\n"
           "  rebuild        CPU time of mapping all keyframes anew after all moved, ms\n"
           "Surfaces: for the ten largest planes of a map at a recording's true poses, the plane through all "
           "depth\n"
           "readings (every fifth frame) within 3 cm and inside the outline, and how far off the map's is.";
}

void add_flags(Flags& flags, Arguments& arguments) {
    flags.add("sequences", arguments.sequences, "comma-separated, see above");
    flags.add("poses", arguments.poses, "comma-separated, see above");
    flags.add("frames", arguments.frames, "frames a sequence, from its start; 0: all");
    flags.add("data", arguments.data, "folder of the recordings; default: $PLANEMAP_DATA, or ../shared/data");
    flags.add("json", arguments.json,
              "write the rows to this file, or to - (standard output; tables then go to stderr)");
    flags.add("growth", arguments.growth, "how the map grows instead, for simulated walks that go round");
    flags.add("no-octomap", arguments.no_octomap, "no OctoMap to compare with: faster");
    flags.add("v,verbose", arguments.verbose, "list every true plane");
    flags.add("q,quiet", arguments.quiet, "no progress on stderr");
    flags.add(options_of(arguments.pipeline.segmentation), "segmentation-");
    flags.add(options_of(arguments.pipeline.odometry), "odometry-");
    flags.add(options_of(arguments.pipeline.graph), "graph-");
    flags.add(options_of(arguments.pipeline.map.map), "map-");
}

/// Says on stderr how far a sequence is, every 100 frames.
void show_progress(const Arguments& arguments, const std::string& sequence, std::int64_t frames) {
    if (!arguments.quiet && frames > 0 && frames % 100 == 0)
        std::fprintf(stderr, "%s, frame %lld\n", sequence.c_str(), static_cast<long long>(frames));
}

/// The rows of one sequence, for the kinds of poses that were asked for.
std::vector<Row> rows_of(const Arguments& arguments, const std::vector<PosesInfo>& poses,
                         const std::string& sequence, const std::string& input) {
    const auto wanted = [&](const char* name) {
        return std::any_of(poses.begin(), poses.end(), [&](const auto& info) { return info.name == name; });
    };
    RunOptions options;
    options.frames = arguments.frames;
    options.true_poses = wanted("true");
    options.pipeline = arguments.pipeline;
    options.pipeline.with_octomap = !arguments.no_octomap;
    SequenceRun run = run_sequence(
        input, options, [&](std::int64_t frames, Pipeline&) { show_progress(arguments, sequence, frames); });
    const std::optional<std::vector<TruePlane>> truth = true_planes(input, arguments.frames);
    std::vector<Row> rows;
    if (wanted("estimated")) {
        Row& row = rows.emplace_back(Row{sequence, "estimated", run.estimated, std::nullopt, {}});
        if (truth && run.truth) {
            const auto truth_from_map = alignment(at_poses(run.keyframes, *run.truth), row.run.poses);
            if (truth_from_map) row.judgement = judge(*truth, row.run.map, *truth_from_map);
        }
    }
    if (run.true_poses) {
        Row& row = rows.emplace_back(Row{sequence, "true", std::move(*run.true_poses), std::nullopt, {}});
        if (truth) {
            row.judgement = judge(*truth, row.run.map, Pose::Identity());
        } else {
            row.surfaces =
                check_surfaces(input, arguments.frames, options.pipeline.camera, row.run.map, *run.truth);
        }
    }
    return rows;
}

/// Runs the sequences; prints and keeps each row as it comes.
nlohmann::ordered_json print_rows(const Arguments& arguments, const std::vector<std::string>& sequences,
                                  OutputFile& output) {
    std::FILE* out = output.for_people();
    const std::vector<PosesInfo> poses = chosen("poses", arguments.poses, known_poses());
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    std::vector<Row> all;
    std::string remarks;
    std::fprintf(out, "\n%s", table_heading().c_str());
    for (const std::string& sequence : sequences) {
        std::string missing;
        const std::optional<std::string> input = input_of(sequence, arguments.data, missing);
        if (!input) {
            std::fprintf(out, "%s: skipped. %s\n", sequence.c_str(), missing.c_str());
            continue;
        }
        for (Row& row : rows_of(arguments, poses, sequence, *input)) {
            std::fputs(table_line(row).c_str(), out);
            remarks += details(row, arguments.verbose);
            json.push_back(to_json(row));
            all.push_back(std::move(row));
        }
        std::fflush(out);
        // After each sequence: what was measured is kept if a later one fails.
        output.keep(json.dump(1) + "\n");
    }
    std::fprintf(out, "\n%s\n%s", goals(all).c_str(), remarks.c_str());
    return json;
}

nlohmann::ordered_json print_growth(const Arguments& arguments, const std::vector<std::string>& sequences,
                                    std::FILE* out) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const std::string& sequence : sequences) {
        std::string missing;
        const std::optional<std::string> input = input_of(sequence, arguments.data, missing);
        if (!input || !input->starts_with("sim:"))
            throw std::invalid_argument(sequence + ": --growth is for simulated walks");
        const Growth growth =
            measure_growth(*input, arguments.frames, arguments.pipeline,
                           [&](std::int64_t frames) { show_progress(arguments, sequence, frames); });
        std::fprintf(out, "\n%s\n%s", sequence.c_str(), growth_table(growth).c_str());
        json.push_back(to_json(sequence, growth));
    }
    return json;
}

int run(const Arguments& arguments) {
    if (arguments.frames < 0)
        throw std::invalid_argument("frames: " + std::to_string(arguments.frames) + ", must be at least 0");
    const std::vector<std::string> sequences = parse_sequences(arguments.sequences);
    OutputFile output(arguments.json);
    std::FILE* out = output.for_people();
    std::fputs(build_info("none: the truth is exact").c_str(), out);
    const nlohmann::ordered_json json =
        arguments.growth ? print_growth(arguments, sequences, out) : print_rows(arguments, sequences, output);
    output.finish(json.dump(1) + "\n");
    return 0;
}

}  // namespace
}  // namespace planemap::bench_map

int main(int argc, char** argv) {
    using namespace planemap::bench_map;
    Arguments arguments;
    planemap::Flags flags(kProgram, description());
    add_flags(flags, arguments);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::start_logging(kProgram, false);
    return planemap::run_main(kProgram, [&] { return run(arguments); });
}
