// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/table2.hpp"

#include <map>

#include "benchmark/choices.hpp"

namespace planemap::bench_odometry {

namespace {

/// The runs of one half of the table.
struct Part {
    std::string name, what;
    std::vector<SequenceInfo> runs;
};

std::vector<Part> parts() {
    Part office{"office", "five places of a simulated office, in random order", {}};
    for (const char* seed : {"1", "2", "3", "4"}) {
        office.runs.push_back(
            {std::string("sim:visits") + seed, "",
             std::string("office?visits=14&speed=0.7&turn=70&blur=4&jitter=0.009&seed=") + seed, "", 0});
    }
    const Part kitchen{"redkitchen",
                       "five places that it comes back to, by its true poses",
                       {benchmark::named("sequences", "redkitchen", known_sequences())}};
    return {kitchen, office};  // the one that needs no rendering first
}

std::string text_of(const std::string& name, const Table2Line& line) {
    return results::text("%-19s %4d %8d %4d | %6.4f +- %6.4f | %6.4f +- %6.4f | %6.3f +- %5.3f\n",
                         name.c_str(), line.runs, line.revisits, line.lost, line.ate_m.mean, line.ate_m.std,
                         line.rpe_m.mean, line.rpe_m.std, line.rpe_deg.mean, line.rpe_deg.std);
}

Json to_json(const std::string& part, const std::string& method, const Table2Line& line) {
    return {{"table2", part},
            {"method", method},
            {"runs", line.runs},
            {"revisits", line.revisits},
            {"lost", line.lost},
            {"ate_m", line.ate_m.mean},
            {"ate_std_m", line.ate_m.std},
            {"rpe_m", line.rpe_m.mean},
            {"rpe_std_m", line.rpe_m.std},
            {"rpe_deg", line.rpe_deg.mean},
            {"rpe_std_deg", line.rpe_deg.std}};
}

/// The errors of all methods on all runs of a part, by method. Says what is missing.
std::map<std::string, std::vector<evaluation::RevisitErrors>> errors_of(
    const Part& part, const Benchmark& runner, const std::vector<MethodInfo>& methods,
    benchmark::Report& report) {
    std::map<std::string, std::vector<evaluation::RevisitErrors>> errors;
    report.for_each(part.runs, [&](const SequenceInfo& info) {
        const Sequence sequence = runner.open(info);
        if (!sequence.truth) throw benchmark::DataMissing("It has no groundtruth.txt");
        const std::vector<evaluation::VisitedPlace> places = evaluation::find_places(*sequence.truth);
        for (const MethodInfo& method : methods) {
            const Row row = runner.run(sequence, method);
            const auto error = evaluation::revisit_errors(*sequence.truth, row.run.trajectory, places);
            if (error) {
                errors[method.name].push_back(*error);
            } else {
                report.print(method.name + " on " + info.name + ": too few visits with a pose\n");
            }
        }
    });
    return errors;
}

}  // namespace

Table2Line summarised(const std::vector<evaluation::RevisitErrors>& runs) {
    Table2Line line;
    std::vector<double> ate_m, rpe_m, rpe_deg;
    for (const evaluation::RevisitErrors& run : runs) {
        ++line.runs;
        line.revisits += run.revisits;
        line.lost += run.lost;
        ate_m.push_back(run.metres.rmse);
        rpe_m.push_back(run.step_metres.rmse);
        rpe_deg.push_back(run.step_degrees.rmse);
    }
    line.ate_m = statistics(ate_m);
    line.rpe_m = statistics(rpe_m);
    line.rpe_deg = statistics(rpe_deg);
    return line;
}

void print_table2(const Benchmark& runner, const std::vector<MethodInfo>& methods,
                  benchmark::Report& report) {
    for (const Part& part : parts()) {
        report.print(
            "\nTable 2, " + part.name + ": " + part.what +
            "\nmethod              runs revisits lost |  ATE m              |  RPE m              |  RPE "
            "deg\n");
        const auto errors = errors_of(part, runner, methods, report);
        for (const MethodInfo& method : methods) {
            const auto found = errors.find(method.name);
            if (found == errors.end()) continue;
            const Table2Line line = summarised(found->second);
            report.print(text_of(method.name, line));
            report.add(to_json(part.name, method.name, line));
        }
        report.print(results::text("%-38s | %6.4f +- %6.4f | %6.4f +- %6.4f | %6.3f +- %5.3f\n",
                                   "the paper, in its own office", 0.006, 0.003, 0.014, 0.002, 1.30, 0.54));
    }
}

}  // namespace planemap::bench_odometry
