// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/image_filter.hpp"

namespace planemap::odometry {

OdometryFrame ImageFilter::only_new(const OdometryFrame& frame, const News& news) {
    OdometryFrame told = frame;
    if (news.color != News::Image::kNew) told.gray = nullptr;
    old_colors_ = frame.gray != nullptr && told.gray == nullptr ? old_colors_ + 1 : 0;
    if (news.depth != News::Image::kNew) {
        no_depth_ = DepthImage(frame.depth->width, frame.depth->height);
        told.depth = &no_depth_;
        told.regions = {};
    }
    return told;
}

}  // namespace planemap::odometry
