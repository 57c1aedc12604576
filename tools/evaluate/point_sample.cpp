// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/point_sample.hpp"

#include <algorithm>

namespace planemap::evaluation {

PointSample::PointSample(const std::vector<PosedView>& views, std::int64_t most) {
    for (const PosedView& posed : views) readings_ += static_cast<std::int64_t>(posed.view->readings);
    most_ = std::min(most, readings_);
    points_.reserve(static_cast<std::size_t>(most_));
}

void PointSample::add(const JudgedReading& reading) {
    const std::int64_t before = number_ * most_ / readings_, after = ++number_ * most_ / readings_;
    if (after == before) return;
    points_.push_back({reading.p_world.cast<float>(), reading.color,
                       reading.is_explained ? reading.face->id : CloudPoint::kNoPlane});
}

}  // namespace planemap::evaluation
