// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/table2.hpp"

#include <map>
#include <nlohmann/json.hpp>

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
             std::string("office?visits=14&speed=0.7&turn=70&blur=4&jitter=0.009&seed=") + seed, ""});
    }
    const Part kitchen{"redkitchen", "five places that it comes back to, by its true poses",
                       parse_sequences("redkitchen")};
    return {kitchen, office};  // the one that needs no rendering first
}

void print_line(const std::string& name, const Table2Line& line, std::FILE* out) {
    std::fprintf(out, "%-19s %4d %8d %4d | %6.4f +- %6.4f | %6.4f +- %6.4f | %6.3f +- %5.3f\n", name.c_str(),
                 line.runs, line.revisits, line.lost, line.ate_m.mean, line.ate_m.std, line.rpe_m.mean,
                 line.rpe_m.std, line.rpe_deg.mean, line.rpe_deg.std);
}

nlohmann::ordered_json to_json(const std::string& part, const std::string& method, const Table2Line& line) {
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
std::map<std::string, std::vector<RevisitErrors>> errors_of(const Part& part, const Benchmark& benchmark,
                                                            const std::vector<MethodInfo>& methods,
                                                            std::FILE* out) {
    std::map<std::string, std::vector<RevisitErrors>> errors;
    for (const SequenceInfo& info : part.runs) {
        std::string missing;
        const std::optional<Sequence> sequence = benchmark.open(info, missing);
        if (!sequence || !sequence->truth) {
            std::fprintf(out, "%s: skipped. %s\n", info.name.c_str(),
                         sequence ? "It has no groundtruth.txt" : missing.c_str());
            continue;
        }
        const std::vector<Place> places = find_places(*sequence->truth);
        for (const MethodInfo& method : methods) {
            const Row row = benchmark.run(*sequence, method);
            const auto error = revisit_errors(*sequence->truth, row.run.trajectory, places);
            if (error) {
                errors[method.name].push_back(*error);
            } else {
                std::fprintf(out, "%s on %s: too few visits with a pose\n", method.name.c_str(),
                             info.name.c_str());
            }
        }
    }
    return errors;
}

}  // namespace

Table2Line summarised(const std::vector<RevisitErrors>& runs) {
    Table2Line line;
    std::vector<double> ate_m, rpe_m, rpe_deg;
    for (const RevisitErrors& run : runs) {
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

nlohmann::ordered_json print_table2(const Benchmark& benchmark, const std::vector<MethodInfo>& methods,
                                    std::FILE* out) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Part& part : parts()) {
        std::fprintf(out,
                     "\nTable 2, %s: %s\n"
                     "method              runs revisits lost |  ATE m              |  RPE m              | "
                     " RPE deg\n",
                     part.name.c_str(), part.what.c_str());
        std::fflush(out);
        const auto errors = errors_of(part, benchmark, methods, out);
        for (const MethodInfo& method : methods) {
            const auto found = errors.find(method.name);
            if (found == errors.end()) continue;
            const Table2Line line = summarised(found->second);
            print_line(method.name, line, out);
            json.push_back(to_json(part.name, method.name, line));
        }
        std::fprintf(out, "%-38s | %6.4f +- %6.4f | %6.4f +- %6.4f | %6.3f +- %5.3f\n",
                     "the paper, in its own office", 0.006, 0.003, 0.014, 0.002, 1.30, 0.54);
    }
    return json;
}

}  // namespace planemap::bench_odometry
