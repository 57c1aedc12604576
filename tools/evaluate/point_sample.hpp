// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/cloud_point.hpp"
#include "evaluate/soundness.hpp"

namespace planemap::evaluation {

/// Some of the depth readings of a run, at even steps through all of them: each view gives its share, and
/// within a view they lie evenly. So their shares are those of all readings, and the same readings give the
/// same points.
class PointSample {
  public:
    static constexpr std::int64_t kMost = 200000;

    /// All of the readings come that these views have.
    explicit PointSample(const std::vector<PosedView>& views, std::int64_t most = kMost);

    /// Takes every reading, in order.
    void add(const JudgedReading& reading);
    /// With the id of the plane that explains each.
    const std::vector<CloudPoint>& points() const { return points_; }

  private:
    std::int64_t readings_ = 0, most_, number_ = 0;
    std::vector<CloudPoint> points_;
};

}  // namespace planemap::evaluation
