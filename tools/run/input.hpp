// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/histogram.hpp"
#include "core/trajectory.hpp"
#include "messages/bus.hpp"
#include "messages/spent.hpp"
#include "results/result_folder.hpp"
#include "sensor/source.hpp"

namespace planemap {

namespace pipeline {
class Preparation;
}

/// What planemap-run reads: puts one frame after the other on the bus, as a sensor would.
class Input {
  public:
    virtual ~Input() = default;
    /// Publishes up to and including the next frame; false when there is none.
    bool feed();
    /// True when feed() found the end of the input, not before it and not because of a failure().
    bool is_at_end() const { return is_at_end_ && failure().empty(); }
    /// Frames that were read, the broken ones included.
    virtual std::int64_t frames() const = 0;
    /// How far the input is read, 0 to 1; nothing if that is not known.
    virtual std::optional<double> progress() const = 0;
    /// What the user should know at the end (skipped bytes, broken frames), a line each; empty if all is
    /// well.
    virtual std::vector<std::string> complaints() const = 0;
    /// Why the input ended before its end (a disk that fails); empty if it did not.
    virtual std::string failure() const { return {}; }
    /// The true trajectory of the colour camera, if the input knows it (groundtruth.txt of a folder, the
    /// simulator).
    virtual std::optional<Trajectory> truth() const { return std::nullopt; }
    /// What only the simulator knows: groundtruth.txt and planes_truth.json.
    virtual std::vector<Result> truth_results() const { return {}; }
    /// What each feed() took, ms: reading and decoding files, or rendering, and putting it on the bus. By the
    /// clock, without waiting for another thread, and CPU time of the threads that did it.
    const Histogram& read_ms() const { return read_ms_; }
    const Histogram& read_cpu_ms() const { return read_cpu_ms_; }
    /// True when that is rendering.
    virtual bool is_simulated() const { return false; }

  private:
    /// Reads what publish_next() publishes, or waits until another thread has; returns what reading took.
    virtual messages::Spent read_next() = 0;
    virtual bool publish_next() = 0;

    Histogram read_ms_, read_cpu_ms_;
    bool is_at_end_ = false;
};

/// Opens anything that sensor::open_source() opens. With a preparation, which must outlive it, as many
/// threads as that has read and prepare the next frames while the bus handles the present one; else one
/// thread does all. Throws std::runtime_error or std::invalid_argument with one line that names input and
/// reason.
std::unique_ptr<Input> open_input(const std::string& name, messages::Bus& bus,
                                  const sensor::SourceOptions& options = {},
                                  pipeline::Preparation* preparation = nullptr);

/// Feeds an input to its end, or until it gave `max_frames` (0: all). Calls `after_each` with the frames so
/// far.
void feed_all(Input& input, std::int64_t max_frames,
              const std::function<void(std::int64_t frames)>& after_each);

}  // namespace planemap
