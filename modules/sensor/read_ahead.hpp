// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "sensor/source.hpp"

namespace planemap::sensor {

/// Reads a source on a thread of its own, one frame ahead, so that who publishes the frames never waits for a
/// disk or a camera.
class ReadAhead {
  public:
    /// What one FrameSource::next() gave.
    struct Item {
        ReadResult result;
        SensorFrame frame;
    };

    explicit ReadAhead(std::shared_ptr<FrameSource> source);
    ~ReadAhead() { stop(); }
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;

    /// The next item, in order; nothing if none comes within `wait`. After kEnd there is nothing more. Throws
    /// what FrameSource::next() threw.
    std::optional<Item> take(std::chrono::milliseconds wait);

    /// Reads nothing more. Waits half a second for a read that is under way; one that blocks for longer is
    /// left behind, with its thread and the source, until it returns. True if none was: the source is the
    /// caller's alone.
    bool stop();

  private:
    struct State;
    std::shared_ptr<State> state_;
    std::chrono::milliseconds patience_{500};  ///< with a read that is under way, in all
};

}  // namespace planemap::sensor
