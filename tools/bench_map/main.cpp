// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-map: maps beside the true planes.
#include <algorithm>
#include <stdexcept>

#include "bench_map/growth.hpp"
#include "bench_map/row.hpp"
#include "bench_map/surfaces.hpp"
#include "bench_map/true_poses.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/report.hpp"
#include "evaluate/true_planes.hpp"

namespace planemap::bench_map {

using benchmark::SequenceInfo;

namespace {

constexpr const char* kProgram = "planemap-bench-map";

struct PosesInfo {
    std::string name, what;
};
const std::vector<PosesInfo>& known_poses() {
    static const std::vector<PosesInfo> kPoses{
        {"estimated", "odometry and graph, as planemap-run"},
        {"true", "the same keyframes where they truly were; inputs with a truth only"},
        {"noise1", "the truth with smooth errors of 1 cm and 0.3 deg about each axis (RMS)"},
        {"noise2", "of 2 cm and 0.5 deg"},
        {"noise3", "of 3 cm and 1 deg"},
    };
    return kPoses;
}

/// The kinds of poses that are the truth with errors.
const std::vector<std::pair<std::string, PoseNoise>> kNoise{
    {"noise1", {0.01, 0.3}}, {"noise2", {0.02, 0.5}}, {"noise3", {0.03, 1.0}}};

struct Arguments : benchmark::Options {
    std::string poses = benchmark::names_of(known_poses());
    bool growth = false, no_octomap = false, verbose = false;
    pipeline::PipelineOptions pipeline;
};

/// At walking speed, more than two rounds.
const std::vector<SequenceInfo> kKnownSequences{
    {"sim:building", "", "building?speed=0.8&turn=60&frames=10000", "", 0}};

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
           benchmark::described(known_poses(), 11) +
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
           "  dbl, flt %     outline area that another plane says again (15 cm, 12 deg, facing the same "
           "way), and that\n"
           "                 most views looked through\n"
           "  expl, 5 cm     depth readings of views spread over the run within max(1.5 cm, 3 sigma) of a "
           "plane's\n"
           "                 outline, and within 5 cm; rms, bias: of the first to their planes\n"
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

void add_flags(messages::Flags& flags, Arguments& arguments) {
    benchmark::add_flags(flags, arguments, "frames a sequence, from its start; 0: all");
    flags.add("poses", arguments.poses, "comma-separated, see above");
    flags.add("growth", arguments.growth, "how the map grows instead, for simulated walks that go round");
    flags.add("no-octomap", arguments.no_octomap, "no OctoMap to compare with: faster");
    flags.add("v,verbose", arguments.verbose, "list every true plane");
    flags.add(options_of(arguments.pipeline.segmentation), "segmentation-");
    flags.add(options_of(arguments.pipeline.odometry), "odometry-");
    flags.add(options_of(arguments.pipeline.graph), "graph-");
    flags.add(options_of(arguments.pipeline.map.map), "map-");
}

/// Holds the row's map against the truth.
void judge(const std::vector<evaluation::TruePlane>& truth, const Pose& truth_from_map, Row& row) {
    row.judgement = evaluation::judge(truth, row.run.map, truth_from_map);
    row.edges = evaluation::judge_edges(truth, row.run.map, truth_from_map);
    row.inferred = evaluation::judge_inferred(truth, row.run.map, truth_from_map);
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
    std::vector<std::string> noise_names;
    for (const auto& [name, noise] : kNoise) {
        if (!wanted(name.c_str())) continue;
        noise_names.push_back(name);
        options.noise.push_back(noise);
    }
    options.pipeline = arguments.pipeline;
    options.pipeline.with_octomap = !arguments.no_octomap;
    SequenceRun run = run_sequence(input, options, benchmark::frame_counter(sequence, arguments.quiet));
    const std::optional<std::vector<evaluation::TruePlane>> truth =
        evaluation::true_planes(input, arguments.frames);
    std::vector<Row> rows;
    if (wanted("estimated")) {
        Row& row = rows.emplace_back(Row{sequence, "estimated", run.estimated, std::nullopt, {}});
        if (truth && run.truth) {
            const auto truth_from_map = alignment(at_poses(run.keyframes, *run.truth), row.run.poses);
            if (truth_from_map) judge(*truth, *truth_from_map, row);
        }
    }
    if (run.true_poses) {
        Row& row = rows.emplace_back(Row{sequence, "true", std::move(*run.true_poses), std::nullopt, {}});
        if (truth) {
            judge(*truth, Pose::Identity(), row);
        } else {
            row.surfaces =
                check_surfaces(input, arguments.frames, options.pipeline.camera, row.run.map, *run.truth);
        }
    }
    for (std::size_t i = 0; i < run.noisy.size(); ++i) {
        Row& row =
            rows.emplace_back(Row{sequence, noise_names[i], std::move(run.noisy[i]), std::nullopt, {}});
        if (truth) judge(*truth, Pose::Identity(), row);
    }
    return rows;
}

void report_maps(const Arguments& arguments, const std::vector<SequenceInfo>& sequences,
                 benchmark::Report& report) {
    const std::vector<PosesInfo> poses = benchmark::chosen("poses", arguments.poses, known_poses());
    std::string remarks;
    report.print("\n");
    report.print(table().heading());
    report.for_each(sequences, [&](const SequenceInfo& sequence) {
        for (const Row& row :
             rows_of(arguments, poses, sequence.name, benchmark::input_of(sequence, arguments.data))) {
            report.add(to_json(row), table());
            remarks += details(row, arguments.verbose);
        }
    });
    report.print("\n");
    report.print(goals(report.rows()));
    report.print("\n");
    report.print(remarks);
}

void report_growth(const Arguments& arguments, const std::vector<SequenceInfo>& sequences,
                   benchmark::Report& report) {
    for (const SequenceInfo& sequence : sequences)
        if (sequence.simulator.empty())
            throw std::invalid_argument(sequence.name + ": --growth is for simulated walks");
    report.for_each(sequences, [&](const SequenceInfo& sequence) {
        const Growth growth =
            measure_growth(benchmark::input_of(sequence, arguments.data), arguments.frames,
                           arguments.pipeline, benchmark::frame_counter(sequence.name, arguments.quiet));
        report.print("\n" + sequence.name + "\n" + growth_table(growth));
        report.add(to_json(sequence.name, growth));
    });
}

int run(const Arguments& arguments) {
    const std::vector<SequenceInfo> sequences =
        benchmark::parse_sequences(arguments.sequences, kKnownSequences, benchmark::Unknown::kIsPath);
    benchmark::run_report(arguments, "none: the truth is exact", [&](benchmark::Report& report) {
        (arguments.growth ? report_growth : report_maps)(arguments, sequences, report);
    });
    return 0;
}

}  // namespace
}  // namespace planemap::bench_map

int main(int argc, char** argv) {
    using namespace planemap::bench_map;
    Arguments arguments;
    arguments.sequences = "sim:office?seed=1..5,redkitchen";
    return planemap::benchmark::run_program(kProgram, description(), argc, argv, arguments, add_flags, run);
}
