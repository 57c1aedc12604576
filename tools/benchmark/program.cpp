// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/program.hpp"

#include <memory>

#include "messages/process.hpp"
#include "results/progress_line.hpp"

namespace planemap::benchmark {

void Options::check(FieldErrors& errors) const {
    errors.require(frames >= 0, "frames", frames, "at least 0");
}

void add_flags(messages::Flags& flags, Options& options, const std::string& frames) {
    flags.add("sequences", options.sequences, "comma-separated names, see above");
    flags.add("frames", options.frames, frames);
    flags.add("data", options.data, "folder of the recordings; default: $PLANEMAP_DATA, or ../shared/data");
    flags.add("json", options.json,
              "write the rows to this file, or to - (standard output; tables then go to stderr)");
    flags.add("q,quiet", options.quiet, "no progress on stderr");
}

std::function<void(std::int64_t)> frame_counter(const std::string& what, bool quiet) {
    return [what, line = std::make_shared<ProgressLine>(quiet, 10)](std::int64_t frames) {
        if (line->is_due()) line->show(what + ", frame " + std::to_string(frames));
    };
}

int run_program(const std::string& program, const std::string& description, int argc, char** argv,
                const std::function<void(messages::Flags&)>& add, const std::function<int()>& body) {
    messages::Flags flags(program, description);
    add(flags);
    return messages::run_program(flags, argc, argv, [&] {
        messages::start_logging(program, false);
        return body();
    });
}

}  // namespace planemap::benchmark
