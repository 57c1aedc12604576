// SPDX-License-Identifier: BSD-3-Clause
// The methods that are compared.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench_odometry/run.hpp"
#include "pipeline/pipeline.hpp"

namespace planemap::bench_odometry {

/// A method by name, as --methods takes it.
struct MethodInfo {
    std::string name;
    std::string what;   ///< one line for --help
    bool slow = false;  ///< may be given fewer frames, see --slow-frames
};
const std::vector<MethodInfo>& known_methods();

/// Reads "default,paper"; throws std::invalid_argument for an unknown name, listing what there is.
std::vector<MethodInfo> parse_methods(const std::string& list);

/// Runs a known method on an input as planemap-run takes it (folder, log or simulator name), `max_frames`
/// from its start (0: all), in this process. `options` are those of the project's own methods; what makes a
/// method this method is set on top. Calls on_frame with the frames so far. Throws as open_input().
MethodRun run_method(const std::string& method, const std::string& input, std::int64_t max_frames,
                     const pipeline::PipelineOptions& options,
                     const std::function<void(std::int64_t)>& on_frame);

}  // namespace planemap::bench_odometry
