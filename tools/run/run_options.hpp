// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/option_list.hpp"
#include "messages/camera_flag.hpp"
#include "pipeline/pipeline.hpp"
#include "sensor/source.hpp"

namespace planemap {

/// What planemap-run is told.
struct RunOptions {
    std::string input, frames, size_resolutions = "0.1,0.05,0.02";
    std::filesystem::path output, poses;
    messages::CameraFlag camera;
    sensor::SourceOptions source;
    bool no_octomap = false, quiet = false, verbose = false;
    std::optional<std::uint64_t> seed;
    int threads = 0;
    pipeline::PipelineOptions pipeline;
};

/// --threads.
OptionList thread_options(RunOptions& options);
/// What the report tells besides.
OptionList report_options(RunOptions& options);

/// All flags of planemap-run: its own, the lists above, and those of all modules.
void add_run_flags(messages::Flags& flags, RunOptions& options);

/// The number of threads that --threads asks for: it holds for the libraries, too.
int rule_threads(RunOptions& options);

}  // namespace planemap
