// SPDX-License-Identifier: BSD-3-Clause
// The frames that methods are compared on.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench_segmentation/truth.hpp"
#include "benchmark/sequences.hpp"
#include "core/camera.hpp"
#include "simulator/world.hpp"

namespace planemap::bench {

/// One frame with all that is known of it.
struct BenchFrame {
    DepthImage depth;
    std::optional<Pose> world_from_depth;  ///< true pose of the depth camera
    std::optional<Truth> truth;
};

/// Frames of one sensor, evenly spread over a recording. Every frame has an index in the recording.
struct Sequence {
    std::string name;
    CameraInfo camera;
    std::vector<std::size_t> indices;
    std::function<BenchFrame(std::size_t index)> load;  ///< throws std::runtime_error naming file and reason
};

using benchmark::SequenceInfo;

/// Recordings, a simulated room, labelled images and the worst cases.
const std::vector<SequenceInfo>& known_sequences();

/// Opens a sequence with `frames` frames (0: the sequence's own number), or all there are if fewer. Throws
/// DataMissing, or std::runtime_error naming what cannot be read.
Sequence open_sequence(const SequenceInfo& info, int frames, const std::filesystem::path& data_folder);

/// `count` numbers from 0 to size - 1, evenly spread; all of them if there are not more.
std::vector<std::size_t> evenly_spread(std::size_t size, std::size_t count);

/// A rendered Kinect's camera, and what it sees of a world. World frame of the simulator: z up.
CameraInfo kinect_camera();
BenchFrame render_frame(const simulator::World& world, const CameraInfo& camera,
                        const Pose& world_from_camera, bool noise, std::uint64_t seed);

}  // namespace planemap::bench
