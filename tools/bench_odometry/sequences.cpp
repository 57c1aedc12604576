// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/sequences.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bench_odometry/child.hpp"
#include "benchmark/choices.hpp"
#include "results/result_folder.hpp"
#include "simulate/recording.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::bench_odometry {

namespace {

/// Colour blurred over 15 ms and up to 9 ms away from depth, as a Kinect's.
constexpr const char* kHandHeld = "office?blur=4&jitter=0.009";

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
std::filesystem::path render(const SequenceInfo& info, const std::string& simulator,
                             const SequenceOptions& options,
                             const std::function<void(std::int64_t)>& on_frame) {
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(simulator));
    const std::string prefix = info.name.substr(info.name.find(':') + 1) + "~";
    const std::string stem = prefix + fingerprint_of(info.simulator, *source);
    const auto size = static_cast<std::int64_t>(*source->size());
    const std::filesystem::path whole = options.cache / (stem + ".lcmlog");
    const bool part = options.frames > 0 && options.frames < size && !std::filesystem::exists(whole);
    std::string name = stem;
    if (part) name.append("-").append(std::to_string(options.frames));
    const std::filesystem::path log = options.cache / (name + ".lcmlog");
    if (std::filesystem::exists(log)) return log;
    ResultFolder results(options.cache, {name + ".lcmlog", name + ".txt"}, "." + name + ".part",
                         ResultFolder::Leftovers::kRemove);
    remove_outdated(options.cache, prefix, stem);
    results.make({name + ".txt", [&](const auto& file) { write_trajectory(file, true_poses(*source)); }});
    Bus bus("memq://");
    SensorShellOptions encoding;
    encoding.speed = 0;
    SensorShell sensor(bus, std::move(source), encoding);
    try {
        results.make({name + ".lcmlog", [&](const auto& file) {
                          record(sensor, bus, part ? options.frames : 0, file, on_frame);
                      }});
        if (stop_requested()) throw std::runtime_error(log.string() + ": stopped before it was whole");
        results.replace();
    } catch (...) {
        results.discard();
        throw;
    }
    return log;
}

std::optional<Sequence> open_simulated(const SequenceInfo& info, const SequenceOptions& options,
                                       const std::function<void(std::int64_t)>& on_frame,
                                       std::string& missing) {
    std::string simulator = "sim:" + info.simulator;
    if (!info.poses.empty()) {
        const std::filesystem::path poses = options.data / info.poses;
        if (!std::filesystem::is_regular_file(poses)) {
            missing = poses.string() + ": no such file (set PLANEMAP_DATA, or give --data)";
            return std::nullopt;
        }
        simulator += info.simulator.find('?') == std::string::npos ? '?' : '&';
        simulator += "trajectory=" + poses.string();
    }
    const ChildResult rendered =
        run_in_child([&]() -> nlohmann::json { return render(info, simulator, options, on_frame).string(); });
    std::filesystem::path truth_file = rendered.value.get<std::string>();
    const std::string log = truth_file.string();
    return Sequence{info.name, log, read_trajectory(truth_file.replace_extension(".txt"))};
}

}  // namespace

const std::vector<SequenceInfo>& known_sequences() {
    static const std::vector<SequenceInfo> kSequences{
        {"redkitchen", "Kinect, hand-held, a kitchen with revisits; the truth errs by centimetres", "", ""},
        {"fr1_rpy_start", "Kinect, fast rotations with blur over a desk", "", ""},
        {"fr3_cabinet", "Xtion, around a cabinet, 58 frames 0.67 s apart", "", ""},
        {"livingroom_micro", "synthetic living room without noise; no truth", "", ""},
        {"sim:kt0", "simulated office, a recorded hand-held trajectory of 6.5 m, Kinect noise, blur, jitter",
         kHandHeld, "handheld_poses/kt0.txt"},
        {"sim:kt1", "simulated office, the same, a trajectory of 2.1 m", kHandHeld, "handheld_poses/kt1.txt"},
        {"sim:kt2", "simulated office, the same, a trajectory of 8.4 m", kHandHeld, "handheld_poses/kt2.txt"},
        {"sim:kt3", "simulated office, the same, a trajectory of 11.3 m", kHandHeld,
         "handheld_poses/kt3.txt"},
        {"sim:building", "simulated corridor around a block, 1.1 rounds of 100 m at walking speed",
         "building?blur=4&jitter=0.009&speed=1.2&turn=60&frames=2850", ""},
        {"sim:spin", "simulated office, fast rotations with blur",
         "office?blur=8&jitter=0.009&speed=1&turn=180&frames=600", ""},
        {"sim:wall", "simulated: along a wall, 6 m of it bare", "wall?blur=4&jitter=0.009&frames=1300", ""},
        {"sim:clutter", "simulated: small boxes any way up, no plane",
         "clutter?blur=4&jitter=0.009&frames=600", ""},
        {"sim:dark", "simulated office without light: depth alone", "office?light=0&jitter=0.009&frames=870",
         ""},
        {"sim:twins", "simulated: two rooms that nothing tells apart, and a corridor",
         "twins?blur=4&jitter=0.009&speed=0.8&turn=70&frames=2100", ""},
    };
    return kSequences;
}

std::vector<SequenceInfo> parse_sequences(const std::string& list) {
    return chosen("sequences", list, known_sequences());
}

std::optional<Sequence> open_sequence(const SequenceInfo& info, const SequenceOptions& options,
                                      const std::function<void(std::int64_t)>& on_frame,
                                      std::string& missing) {
    if (!info.simulator.empty()) return open_simulated(info, options, on_frame, missing);
    const std::filesystem::path folder = options.data / info.name;
    if (!std::filesystem::is_directory(folder)) {
        missing = folder.string() + ": no such folder (set PLANEMAP_DATA, or give --data)";
        return std::nullopt;
    }
    Sequence sequence{info.name, folder.string(), std::nullopt};
    const std::filesystem::path truth_file = folder / "groundtruth.txt";
    if (std::filesystem::is_regular_file(truth_file)) sequence.truth = read_trajectory(truth_file);
    return sequence;
}

}  // namespace planemap::bench_odometry
