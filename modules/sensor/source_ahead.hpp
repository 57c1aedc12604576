// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/work_ahead.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/spent.hpp"
#include "sensor/source.hpp"

namespace planemap::sensor {

/// A source whose next frames are read and prepared while the present one is worked on (WorkAhead): the same
/// frames, faults and exceptions in the same order. Of a live camera one frame at most waits here.
class SourceAhead : public FrameSource {
  public:
    /// What of a frame can be made before its message comes; nullptr: nothing. Called as WorkAhead says.
    using Prepare = std::function<std::shared_ptr<messages::Frame>(const SensorFrame& frame, int worker)>;

    /// One FrameSource::next(): what it gave, and what it took on the thread that called it.
    struct Item {
        ReadResult result;
        SensorFrame frame;
        std::optional<double> progress;
        messages::Spent spent;
        std::shared_ptr<messages::Frame> prepared;
    };

    SourceAhead(std::unique_ptr<FrameSource> source, int threads, Prepare prepare);

    /// Waits for what next() gives the next time. Throws what it would throw. Refers to it until next().
    const Item& fetch();

    const CameraInfo& camera() const override { return source_->camera(); }
    std::optional<std::size_t> size() const override { return size_; }
    ReadResult next(SensorFrame& frame) override;
    bool is_live() const override { return source_->is_live(); }
    std::vector<std::string> notes() const override { return notes_; }
    std::vector<std::string> complaints() const override;
    std::string end() override;
    std::optional<double> progress() const override { return progress_; }
    const FrameSource& origin() const override { return source_->origin(); }

  private:
    bool read(Item& item);

    std::unique_ptr<FrameSource> source_;  ///< used by who reads alone, but for what never changes
    std::optional<std::size_t> size_;
    std::vector<std::string> notes_;
    std::optional<double> progress_;  ///< when the frame that was taken last had been read
    std::optional<Item> fetched_;
    std::unique_ptr<WorkAhead<Item>> ahead_;  ///< last: its threads use what is above
};

/// How many frames are read and wait for their turn: one for each thread to work on, and one more, since a
/// frame that becomes a keyframe takes three times as long as others. Of a live camera only one, which would
/// grow old.
std::size_t frames_ahead(int threads, bool is_live);

}  // namespace planemap::sensor
