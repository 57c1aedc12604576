// SPDX-License-Identifier: BSD-3-Clause
// What every benchmark is asked, and how it runs as a program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "benchmark/sequences.hpp"
#include "core/validation.hpp"
#include "messages/flags.hpp"

namespace planemap::benchmark {

struct Options {
    std::string sequences;                               ///< comma-separated names
    int frames = 0;                                      ///< a sequence; 0: as the benchmark has it
    std::filesystem::path data = default_data_folder();  ///< of the recordings
    std::filesystem::path json;                          ///< for the rows; "-": standard output; empty: none
    bool quiet = false;                                  ///< no progress on stderr

    void check(FieldErrors& errors) const;
};

/// Their flags; `frames` says which frames are taken.
void add_flags(messages::Flags& flags, Options& options, const std::string& frames);

/// Says on stderr how many frames of `what` there are so far; each copy goes on from the others.
std::function<void(std::int64_t frames)> frame_counter(const std::string& what, bool quiet);

/// Parses the flags that `add` adds, and runs `body`. Returns the exit code: 1 for an error (one line on
/// stderr), 2 for wrong flags.
int run_program(const std::string& program, const std::string& description, int argc, char** argv,
                const std::function<void(messages::Flags&)>& add, const std::function<int()>& body);

/// The same for a benchmark whose flags write into `arguments`: `add` adds them, and `run` takes what they
/// said.
template <typename Arguments>
int run_program(const std::string& program, const std::string& description, int argc, char** argv,
                Arguments arguments, void (*add)(messages::Flags&, Arguments&),
                int (*run)(const Arguments&)) {
    return run_program(
        program, description, argc, argv, [&](messages::Flags& flags) { add(flags, arguments); },
        [&] { return run(arguments); });
}

}  // namespace planemap::benchmark
