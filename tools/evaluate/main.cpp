// SPDX-License-Identifier: BSD-3-Clause
// planemap-evaluate: a trajectory, and in a simulated world a map, against the truth.
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/files.hpp"
#include "core/standard_output.hpp"
#include "core/trajectory_file.hpp"
#include "evaluate/edge_judge.hpp"
#include "evaluate/evaluation.hpp"
#include "evaluate/evaluation_report.hpp"
#include "evaluate/judgement_report.hpp"
#include "evaluate/true_planes.hpp"
#include "map/map_file.hpp"
#include "messages/process.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap {
namespace {

struct Arguments {
    std::string truth_file, estimate_file, json_file;
    EvaluationOptions options;
    std::optional<double> delta;
    std::string delta_unit = "s";
};

const std::map<std::string, DeltaUnit> delta_units{{"s", DeltaUnit::seconds},
                                                   {"m", DeltaUnit::metres},
                                                   {"rad", DeltaUnit::radians},
                                                   {"deg", DeltaUnit::degrees},
                                                   {"f", DeltaUnit::frames}};

void add_flags(messages::Flags& flags, Arguments& arguments) {
    flags.add_positional(
        "TRUTH", arguments.truth_file,
        "true trajectory: lines `timestamp tx ty tz qx qy qz qw` (TUM), EuRoC's csv, or "
        "KITTI's 12 numbers a line; timestamps in s, ms, us or ns, known by their size. A simulated "
        "input (sim:office?frames=300) tells the true poses and the true planes");
    flags.add_positional(
        "ESTIMATE", arguments.estimate_file,
        "estimated trajectory, in any of these forms; KITTI's has no timestamps and goes with "
        "KITTI's only: pose i with pose i. For a simulated TRUTH: the folder that planemap-run "
        "left, of which trajectory.txt and plane_map.lcmlog are judged");
    flags.add("json", arguments.json_file,
              "write the figures as JSON to this file, or to - (standard output)");
    flags.add("max-difference", arguments.options.max_difference_s,
              "seconds by which matched stamps differ at most");
    flags.add("offset", arguments.options.offset_s, "seconds added to the estimate's stamps");
    flags.add("scale", arguments.options.scale,
              "factor on the estimate's translations; give the printed scale to align over Sim(3)");
    flags.add("delta", arguments.delta, "one more RPE, over this delta (see --delta-unit)");
    flags.add_choice("delta-unit", arguments.delta_unit, {"s", "f", "m", "rad", "deg"},
                     "of --delta: s seconds, f frames, or m, rad, deg along the estimate");
}

/// Why there is no ATE, in one line.
std::string too_few_pairs(const Arguments& arguments, const Trajectory& truth, const Trajectory& estimate,
                          std::size_t pairs) {
    if (pairs == 0) {
        return "no overlap in time: " + arguments.estimate_file + " covers " + span_text(estimate) +
               ", the truth " + arguments.truth_file + " " + span_text(truth) +
               " (see --offset and --max-difference)";
    }
    return "only " + std::to_string(pairs) + " poses of " + arguments.estimate_file + " match poses of " +
           arguments.truth_file + " in time, at least 3 are needed (see --offset and --max-difference)";
}

void print_row(const std::string& name, const char* unit, const Statistics& s) {
    std::printf("%-16s %-4s %9.4f %9.4f %9.4f %9.4f %9.4f %9.4f\n", name.c_str(), unit, s.rmse, s.mean,
                s.median, s.std, s.min, s.max);
}

void print_rows(const std::string& name, const std::optional<RelativeError>& error, const std::string& why) {
    if (!error) {
        std::printf("%-16s %s\n", name.c_str(), why.c_str());
        return;
    }
    print_row(name, "m", error->metres);
    print_row("", "deg", error->degrees);
    if (error->left_out > 0) {
        std::printf("%-16s of %zu pairs; for %zu more the truth has no poses near enough in time\n", "",
                    error->metres.count, error->left_out);
    }
}

void print_table(const Evaluation& evaluation) {
    std::printf("matched %zu of %zu poses (truth: %zu), true path %.2f m, scale %.4f\n", evaluation.pairs,
                evaluation.estimate_poses, evaluation.truth_poses, evaluation.path_length_m,
                evaluation.ate->scale);
    std::printf("%-16s %-4s %9s %9s %9s %9s %9s %9s\n", "", "", "rmse", "mean", "median", "std", "min",
                "max");
    print_row("ATE", "m", evaluation.ate->metres);
    print_rows("RPE per frame", evaluation.rpe_frame, evaluation.why_no_rpe_frame);
    print_rows("RPE per 1 s", evaluation.rpe_1s, evaluation.why_no_rpe_1s);
}

void print_judgement(const evaluation::Judgement& judgement) {
    std::printf("map: %zu of %zu true planes found, %zu map planes too many (split), %zu spurious\n",
                judgement.found(), judgement.seen(), judgement.split(), judgement.spurious.size());
    const auto row = [](const char* name, const char* unit, const Statistics& errors) {
        if (errors.count > 0) print_row(name, unit, errors);
    };
    row("distances", "m", evaluation::errors_of(judgement.distances));
    row("angles", "deg", evaluation::errors_of(judgement.angles));
    if (const auto iou = judgement.outline_iou()) std::printf("outlines: IoU %.3f\n", *iou);
    print(evaluation::judgement_details(judgement, false));
}

void print_edges(const evaluation::EdgeJudgement& edges) {
    const auto percent = [](const std::optional<double>& share) { return 100 * share.value_or(0); };
    std::printf("edges: %.1f %% of %.1f m found, %.1f %% of the map's %.1f m right\n",
                percent(edges.edges_found()), edges.true_m, percent(edges.lines_right()), edges.lines_m);
    std::printf("corners: %zu of %zu found, %zu of the map's %zu right\n", edges.met, edges.corners,
                edges.right_points, edges.points);
}

void print_inferred(const evaluation::InferredJudgement& inferred) {
    std::printf("inferred: %.2f m2, %.1f %% of it on the true plane\n", inferred.area_m2,
                100 * inferred.right().value_or(0));
}

/// The two trajectories, and how their poses are matched: by time, or without timestamps by their number.
struct Pair {
    TrajectoryFile truth, estimate;
    bool by_index = false;
};

bool is_simulated(const std::string& truth) {
    return truth.starts_with("sim:");
}

/// Of a simulated input and a result folder, whose trajectory is then the estimate's file.
Pair simulated_pair(Arguments& arguments) {
    const std::filesystem::path folder = arguments.estimate_file;
    if (!std::filesystem::is_directory(folder)) {
        throw std::runtime_error(
            arguments.estimate_file +
            ": no folder; a simulated TRUTH goes with the folder that planemap-run left");
    }
    const simulator::SimulatedSource source(simulator::parse_simulator_name(arguments.truth_file));
    arguments.estimate_file = (folder / "trajectory.txt").string();
    return {{.poses = source.ground_truth(), .notes = {}}, read_trajectory_file(arguments.estimate_file)};
}

Pair read_pair(Arguments& arguments) {
    Pair pair = is_simulated(arguments.truth_file) ? simulated_pair(arguments)
                                                   : Pair{read_trajectory_file(arguments.truth_file),
                                                          read_trajectory_file(arguments.estimate_file)};
    require_poses(arguments.truth_file, pair.truth.poses);
    require_poses(arguments.estimate_file, pair.estimate.poses);
    for (const TrajectoryFile* file : {&pair.truth, &pair.estimate})
        for (const std::string& note : file->notes)
            std::fprintf(stderr, "planemap-evaluate: %s\n", note.c_str());
    pair.by_index = pair.truth.format == TrajectoryFormat::kKitti;
    if (pair.by_index != (pair.estimate.format == TrajectoryFormat::kKitti)) {
        throw std::runtime_error(
            (pair.by_index ? arguments.truth_file : arguments.estimate_file) +
            ": KITTI's form (12 numbers a line) has no timestamps and can only be compared with another of "
            "the "
            "same form, but " +
            (pair.by_index ? arguments.estimate_file : arguments.truth_file) + " is in " +
            format_name(pair.by_index ? pair.estimate.format : pair.truth.format) + "'s");
    }
    if (!pair.by_index) return pair;
    if (pair.truth.poses.size() != pair.estimate.poses.size()) {
        throw std::runtime_error(arguments.estimate_file + " has " +
                                 std::to_string(pair.estimate.poses.size()) + " poses, " +
                                 arguments.truth_file + " " + std::to_string(pair.truth.poses.size()) +
                                 ": without timestamps (KITTI's form) pose i is compared with pose i, so "
                                 "both must be equally long");
    }
    if (arguments.options.offset_s != 0)
        throw std::invalid_argument("--offset: KITTI's form has no timestamps to add it to");
    if (arguments.delta && arguments.delta_unit == "s")
        throw std::invalid_argument("--delta-unit s: KITTI's form has no timestamps; f, m, rad or deg");
    return pair;
}

/// Throws std::runtime_error where there is no ATE.
Evaluation evaluated(const Arguments& arguments, const Pair& pair) {
    const Trajectory &truth = pair.truth.poses, &estimate = pair.estimate.poses;
    Evaluation evaluation = pair.by_index ? evaluate_by_index(truth, estimate, arguments.options)
                                          : evaluate(truth, estimate, arguments.options);
    if (!evaluation.ate && pair.by_index)
        throw std::runtime_error(arguments.estimate_file + ": at least 3 poses are needed");
    if (!evaluation.ate)
        throw std::runtime_error(too_few_pairs(arguments, truth, estimate, evaluation.pairs));
    return evaluation;
}

/// The RPE over --delta, as JSON and for people.
void add_delta(const Arguments& arguments, const Pair& pair, bool as_text, nlohmann::ordered_json& json) {
    const Delta delta{*arguments.delta, delta_units.at(arguments.delta_unit)};
    const Trajectory truth = without_repeated_stamps(pair.truth.poses),
                     estimate = without_repeated_stamps(pair.estimate.poses);
    const auto error = relative_error(truth, estimate, delta, arguments.options);
    const std::string why = error ? "" : why_no_relative_error(truth, estimate, delta);
    char name[40];
    std::snprintf(name, sizeof(name), "RPE per %g %s", delta.value, arguments.delta_unit.c_str());
    if (as_text) print_rows(name, error, why);
    json["rpe_delta"] = evaluation::relative_figures(error);
    if (!error) json["rpe_delta_why"] = why;
    json["delta"] = delta.value;
    json["delta_unit"] = arguments.delta_unit;
}

/// A map beside the planes of a simulated truth, and beside where these meet.
struct JudgedMap {
    evaluation::Judgement planes;
    evaluation::EdgeJudgement edges;
    evaluation::InferredJudgement inferred;
};

/// The map in `folder`; nothing for another truth than a simulated one.
std::optional<JudgedMap> judged_map(const std::string& truth, const std::filesystem::path& folder,
                                    const Pose& truth_from_map) {
    const auto planes = evaluation::true_planes(truth, 0);
    if (!planes) return std::nullopt;
    const PlaneMap map = map::read_plane_map(folder / "plane_map.lcmlog");
    return JudgedMap{evaluation::judge(*planes, map, truth_from_map),
                     evaluation::judge_edges(*planes, map, truth_from_map),
                     evaluation::judge_inferred(*planes, map, truth_from_map)};
}

void run(Arguments arguments) {
    const std::filesystem::path folder = arguments.estimate_file;
    arguments.options.validate();
    if (arguments.delta && !(*arguments.delta > 0))
        throw std::invalid_argument("--delta must be greater than 0");
    const Pair pair = read_pair(arguments);
    const Evaluation evaluation = evaluated(arguments, pair);
    const auto judgement = judged_map(arguments.truth_file, folder, evaluation.ate->truth_from_estimate);

    nlohmann::ordered_json json = evaluation::all_figures(evaluation);
    json["truth_format"] = format_name(pair.truth.format);
    json["estimate_format"] = format_name(pair.estimate.format);
    json["matched_by"] = pair.by_index ? "index" : "time";
    if (judgement) {
        json["map"] = evaluation::figures_of(std::optional(judgement->planes));
        json["map"].update(evaluation::edge_figures(std::optional(judgement->edges)));
        json["map"].update(evaluation::inferred_figures(std::optional(judgement->inferred)));
    }
    const bool as_text = arguments.json_file != "-";
    if (as_text && pair.by_index)
        std::printf("KITTI's form has no timestamps: pose i is compared with pose i\n");
    if (as_text) print_table(evaluation);
    if (arguments.delta) add_delta(arguments, pair, as_text, json);
    if (as_text && judgement) {
        print_judgement(judgement->planes);
        print_edges(judgement->edges);
        print_inferred(judgement->inferred);
    }
    if (arguments.json_file == "-") {
        print(json.dump(2) + "\n");
    } else if (!arguments.json_file.empty()) {
        write_file(arguments.json_file, json.dump(2) + "\n");
    }
    finish_printing();
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::Arguments arguments;
    planemap::messages::Flags flags(
        "planemap-evaluate",
        "Compares a trajectory with the truth as the TUM RGB-D benchmark does: absolute "
        "trajectory error (ATE) after\n"
        "rigid alignment, and relative pose error (RPE) per frame and per second. For the RPE the truth's "
        "pose is "
        "the nearest within 5 ms,\n"
        "else interpolated between poses at most 0.1 s apart; where the truth is sparser, the RPE "
        "is not measured.");
    planemap::add_flags(flags, arguments);
    return planemap::messages::run_program(flags, argc, argv, [&] {
        planemap::run(arguments);
        return 0;
    });
}
