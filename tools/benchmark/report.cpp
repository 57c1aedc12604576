// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/report.hpp"

#include <cstdio>

#include "benchmark/build_info.hpp"

namespace planemap::benchmark {

Report::Report(const Options& options, const std::string& peers) : output_(options.json) {
    print(build_info(peers));
}

void Report::print(const std::string& text) {
    std::fputs(text.c_str(), output_.for_people());
    std::fflush(output_.for_people());
}

void Report::add(Json row, const Table& table) {
    print(table.line(row));
    add(std::move(row));
}

void Report::for_each(const std::vector<SequenceInfo>& sequences,
                      const std::function<void(const SequenceInfo&)>& measure) {
    for (const SequenceInfo& sequence : sequences) {
        try {
            measure(sequence);
        } catch (const DataMissing& missing) {
            print(sequence.name + ": skipped. " + missing.what() + "\n");
            continue;
        }
        output_.keep(Json(rows_).dump(1) + "\n");
    }
}

void Report::finish() {
    output_.finish(Json(rows_).dump(1) + "\n");
}

void run_report(const Options& options, const std::string& peers,
                const std::function<void(Report&)>& measure) {
    FieldErrors errors("benchmark options");
    options.check(errors);
    errors.throw_if_any();
    Report report(options, peers);
    measure(report);
    report.finish();
}

}  // namespace planemap::benchmark
