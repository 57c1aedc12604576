// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-segmentation: methods that find planes in depth images, on the same frames.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench_segmentation/build_info.hpp"
#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/methods.hpp"
#include "bench_segmentation/row.hpp"
#include "bench_segmentation/sequences.hpp"
#include "core/files.hpp"
#include "messages/process.hpp"

namespace planemap::bench {
namespace {

struct Arguments {
    std::string sequences, methods;
    int frames = 0, slow_frames = 20;
    std::filesystem::path data, json;
    bool quiet = false;
};

/// Folder of the sample data, as the tests find it.
std::filesystem::path default_data_folder() {
    if (const char* root = std::getenv("PLANEMAP_DATA")) return root;
    return std::filesystem::path(PLANEMAP_SOURCE) / ".." / "shared" / "data";
}

std::string default_methods() {
    std::string list;
    for (const MethodInfo& info : known_methods()) list += (list.empty() ? "" : ",") + info.name;
    return list;
}

std::string default_sequences() {
    std::string list;
    for (const SequenceInfo& info : known_sequences()) list += (list.empty() ? "" : ",") + info.name;
    return list;
}

void add_flags(Flags& flags, Arguments& arguments) {
    flags.add("sequences", arguments.sequences, "comma-separated names, see above");
    flags.add("methods", arguments.methods,
              "comma-separated names, see above; NAME/N runs at subsampling N only");
    flags.add("frames", arguments.frames, "frames a sequence, evenly spread; 0: each sequence's own");
    flags.add("slow-frames", arguments.slow_frames, "at most this many frames for a slow method");
    flags.add("data", arguments.data, "folder of the sample data");
    flags.add("json", arguments.json, "write the rows to this file, - for standard output");
    flags.add("q,quiet", arguments.quiet, "no progress on stderr");
}

bool is_slow(const MethodName& method) {
    for (const MethodInfo& info : known_methods()) {
        if (info.name != method.name) continue;
        return std::count(info.slow_subsamplings.begin(), info.slow_subsamplings.end(), method.subsampling) >
               0;
    }
    return false;
}

/// A row, the method that fills it, and the frames of the recording that it gets.
struct Contender {
    Row row;
    Method method;
    std::vector<std::size_t> indices;
};

/// Times one frame: the median of a few runs, so that a moment's interruption does not count; a run that
/// takes long is not repeated.
double time_frame(Method& method, const DepthImage& depth, const CameraInfo& camera) {
    constexpr int kRuns = 3;
    constexpr double kLong_ms = 20;
    std::vector<double> ms{method.run(depth, camera)};
    while (ms.size() < kRuns && ms.front() < kLong_ms) ms.push_back(method.run(depth, camera));
    return median(ms);
}

class Benchmark {
  public:
    explicit Benchmark(const Arguments& arguments) : arguments_(arguments) {}

    /// Runs every method on a sequence, frame by frame, and prints its table.
    void run(const SequenceInfo& info, const std::vector<MethodName>& methods) {
        const int frames = arguments_.frames > 0 ? arguments_.frames : info.frames;
        std::string missing;
        const auto sequence = open_sequence(info, frames, arguments_.data, missing);
        if (!sequence) {
            std::printf("\n%s: skipped. %s\n", info.name.c_str(), missing.c_str());
            return;
        }
        std::vector<Contender> contenders;
        for (const MethodName& name : methods) {
            const auto count = static_cast<std::size_t>(is_slow(name) ? arguments_.slow_frames : frames);
            std::vector<std::size_t> indices;
            for (const std::size_t i : evenly_spread(sequence->indices.size(), count))
                indices.push_back(sequence->indices[i]);
            Row row;
            row.sequence = info.name;
            row.method = name;
            contenders.push_back({row, Method(name), indices});
        }
        for (const std::size_t index : sequence->indices) run_frame(*sequence, index, contenders);
        end_progress();
        std::printf("\n%s: %s\n%s", info.name.c_str(), info.what.c_str(), table_heading().c_str());
        for (const Contender& contender : contenders) {
            std::fputs(table_line(contender.row).c_str(), stdout);
            json_.push_back(to_json(contender.row));
        }
        std::fflush(stdout);
    }

    const nlohmann::ordered_json& json() const { return json_; }

  private:
    void run_frame(const Sequence& sequence, std::size_t index, std::vector<Contender>& contenders) {
        BenchFrame frame;
        try {
            frame = sequence.load(index);
        } catch (const std::runtime_error& error) {
            end_progress();
            std::fprintf(stderr, "planemap-bench-segmentation: frame left out: %s\n", error.what());
            return;
        }
        const auto normals = local_normals(frame.depth, sequence.camera);
        for (Contender& contender : contenders) {
            if (!std::binary_search(contender.indices.begin(), contender.indices.end(), index)) continue;
            show_progress(sequence, index, contender.row.method);
            const double ms = time_frame(contender.method, frame.depth, sequence.camera);
            contender.row.add(ms, frame, sequence.camera, normals,
                              contender.method.result(frame.depth, sequence.camera));
        }
    }

    void show_progress(const Sequence& sequence, std::size_t index, const MethodName& method) {
        if (arguments_.quiet || ::isatty(STDERR_FILENO) != 1) return;
        std::fprintf(stderr, "\r\033[K%s frame %zu, %s/%d", sequence.name.c_str(), index, method.name.c_str(),
                     method.subsampling);
        drawn_ = true;
    }
    void end_progress() {
        if (drawn_) std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }

    Arguments arguments_;
    nlohmann::ordered_json json_ = nlohmann::ordered_json::array();
    bool drawn_ = false;
};

int run(const Arguments& arguments) {
    if (arguments.frames < 0) throw std::invalid_argument("frames must be at least 0");
    if (arguments.slow_frames < 1) throw std::invalid_argument("slow-frames must be at least 1");
    const std::vector<SequenceInfo> sequences = parse_sequences(arguments.sequences);
    const std::vector<MethodName> methods = parse_methods(arguments.methods);
    std::fputs(build_info().c_str(), stdout);
    Benchmark benchmark(arguments);
    for (const SequenceInfo& sequence : sequences) benchmark.run(sequence, methods);
    const std::string text = benchmark.json().dump(1) + "\n";
    if (arguments.json == "-") {
        std::cout << text;
    } else if (!arguments.json.empty()) {
        write_file(arguments.json, text);
    }
    return 0;
}

}  // namespace
}  // namespace planemap::bench

int main(int argc, char** argv) {
    using namespace planemap::bench;
    const std::string program = "planemap-bench-segmentation";
    std::string description = "Methods that find planes in depth images, on the same frames.\n";
    Arguments arguments;
    arguments.sequences = default_sequences();
    arguments.methods = default_methods();
    arguments.data = default_data_folder();
    planemap::Flags flags(program, description);
    add_flags(flags, arguments);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    return planemap::run_main(program, [&] { return run(arguments); });
}
