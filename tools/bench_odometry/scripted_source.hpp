// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "bench_odometry/disturbances.hpp"
#include "core/frame_source.hpp"

namespace planemap::bench_odometry {

/// The frames of another source as a script shows them; its broken frames are not counted and not shown. Each
/// is read once and kept while it is still to be shown. Ends with the script, or where a frame is to be shown
/// that the source has not.
class ScriptedSource : public SourceAround {
  public:
    /// Precondition: a source that ends.
    ScriptedSource(std::unique_ptr<FrameSource> images, Script script);

    std::optional<std::size_t> size() const override { return script_.size(); }
    ReadResult next(SensorFrame& frame) override;

    /// The moments, in the source's own stamps, of the frames delivered so far: where the camera was then.
    const std::vector<std::int64_t>& moments() const { return moments_; }

  private:
    const SensorFrame* find(std::size_t index);
    void forget();

    Script script_;
    std::vector<std::size_t> last_use_;  ///< by frame of the source: the script's last entry that shows it
    std::map<std::size_t, SensorFrame> kept_;
    std::size_t read_ = 0, next_ = 0;
    std::vector<std::int64_t> moments_;
};

}  // namespace planemap::bench_odometry
