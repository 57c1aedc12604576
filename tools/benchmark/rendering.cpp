// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/rendering.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "benchmark/child.hpp"
#include "messages/process.hpp"
#include "results/result_folder.hpp"
#include "simulate/recording.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::benchmark {

namespace {

/// The true poses at the frames' depth and colour times: a method may give its pose for either.
Trajectory true_poses(const simulator::SimulatedSource& source) {
    Trajectory truth;
    for (std::size_t i = 0; i < *source.size(); ++i) {
        for (const std::int64_t utime : {source.utime(i), source.color_utime(i)})
            truth.push_back({utime, source.world_from_color(utime)});
    }
    std::sort(truth.begin(), truth.end(), [](const auto& a, const auto& b) { return a.utime < b.utime; });
    const auto same_time = [](const auto& a, const auto& b) { return a.utime == b.utime; };
    truth.erase(std::unique(truth.begin(), truth.end(), same_time), truth.end());
    return truth;
}

/// A value of all bytes so far; order counts.
class Fingerprint {
  public:
    template <typename T>
    void add(const std::vector<T>& values) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        for (std::size_t i = 0; i < values.size() * sizeof(T); ++i)
            value_ = (value_ ^ bytes[i]) * 0x100000001b3u;  // FNV-1a
    }
    std::string hex() const {
        char text[20];
        std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(value_));
        return text;
    }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// What tells this simulation from others: its parameters, poses and three frames.
std::string fingerprint_of(const std::string& name, const simulator::SimulatedSource& source) {
    static_assert(sizeof(Rgb) == 3);
    Fingerprint fingerprint;
    fingerprint.add(std::vector<char>(name.begin(), name.end()));
    for (const StampedPose& pose : true_poses(source)) {
        fingerprint.add(std::vector<std::int64_t>{pose.utime});
        const double* matrix = pose.world_from_camera.data();
        fingerprint.add(std::vector<double>(matrix, matrix + 16));
    }
    for (const std::size_t i : {std::size_t{0}, *source.size() / 2, *source.size() - 1}) {
        const SensorFrame frame = source.frame(i);
        fingerprint.add(frame.depth.pixels);
        fingerprint.add(frame.color.pixels);
    }
    return fingerprint.hex();
}

/// Logs and truths of this sequence that were made by another state of the simulator.
void remove_outdated(const std::filesystem::path& cache, const std::string& prefix,
                     const std::string& current) {
    for (const auto& entry : std::filesystem::directory_iterator(cache)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(prefix) && !name.starts_with(current)) std::filesystem::remove(entry.path());
    }
}

/// Renders to the cache what is not there yet; returns the log. Its truth stands beside it, in .txt.
std::filesystem::path render(const SequenceInfo& sequence, const std::string& simulator,
                             const std::filesystem::path& cache, std::int64_t frames,
                             const std::function<void(std::int64_t)>& on_frame) {
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(simulator));
    const std::string prefix = file_name_of(sequence.name.substr(sequence.name.find(':') + 1)) + "~";
    const std::string stem = prefix + fingerprint_of(sequence.simulator, *source);
    const auto size = static_cast<std::int64_t>(*source->size());
    const std::filesystem::path whole = cache / (stem + ".lcmlog");
    const bool part = frames > 0 && frames < size && !std::filesystem::exists(whole);
    std::string name = stem;
    if (part) name.append("-").append(std::to_string(frames));
    const std::filesystem::path log = cache / (name + ".lcmlog");
    if (std::filesystem::exists(log)) return log;
    ResultFolder results(cache, {name + ".lcmlog", name + ".txt"}, "." + name + ".part",
                         ResultFolder::Leftovers::kRemove);
    remove_outdated(cache, prefix, stem);
    results.make({name + ".txt", [&](const auto& file) { write_trajectory(file, true_poses(*source)); }});
    try {
        results.make({name + ".lcmlog", [&](const auto& file) {
                          record(std::move(source), part ? frames : 0, file, on_frame);
                      }});
        if (messages::stop_requested())
            throw std::runtime_error(log.string() + ": stopped before it was whole");
        results.replace();
    } catch (...) {
        results.discard();
        throw;
    }
    return log;
}

}  // namespace

std::filesystem::path default_cache_folder(const std::string& program) {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache != nullptr && *cache != '\0') return std::filesystem::path(cache) / program;
    return (home != nullptr ? std::filesystem::path(home) / ".cache" : std::filesystem::path("/tmp")) /
           program;
}

std::filesystem::path rendered_log(const SequenceInfo& sequence, const std::filesystem::path& data,
                                   const std::filesystem::path& cache, std::int64_t frames,
                                   const std::function<void(std::int64_t)>& on_frame) {
    const std::string simulator = input_of(sequence, data);
    const ChildResult rendered = run_in_child(
        [&]() -> nlohmann::json { return render(sequence, simulator, cache, frames, on_frame).string(); });
    return rendered.value.get<std::string>();
}

}  // namespace planemap::benchmark
