// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/corrected_source.hpp"

#include <utility>

#include "core/depth_correction.hpp"

namespace planemap::sensor {

CorrectedSource::CorrectedSource(std::unique_ptr<FrameSource> source, const CameraInfo& sensed)
    : SourceAround(std::move(source)), sensed_(sensed), camera_(sensed) {
    camera_.depth_correction.reset();
}

ReadResult CorrectedSource::next(SensorFrame& frame) {
    ReadResult result = source().next(frame);
    if (result.status != ReadResult::Status::kFrame) return result;
    correct_depth(frame.depth, sensed_);
    frame.depth_zipped.clear();
    return result;
}

}  // namespace planemap::sensor
