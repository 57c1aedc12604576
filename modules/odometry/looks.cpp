// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/looks.hpp"

#include <algorithm>
#include <utility>

namespace planemap::odometry {

namespace {

std::vector<PlanarRegion> valid(std::span<const PlanarRegion> regions) {
    std::vector<PlanarRegion> result;
    std::copy_if(regions.begin(), regions.end(), std::back_inserter(result),
                 [](const PlanarRegion& region) { return is_valid(region); });
    return result;
}

std::vector<Plane> planes_of(const std::vector<PlanarRegion>& regions) {
    std::vector<Plane> planes;
    planes.reserve(regions.size());
    for (const PlanarRegion& region : regions) planes.push_back(region.plane);
    return planes;
}

}  // namespace

void Looks::begin(const Keyframe& keyframe) {
    std::erase_if(places_, [&](const Place& place) { return place.keyframe_id == keyframe.id; });
    Place& place = places_.emplace_back();
    place.keyframe_id = last_keyframe_id_ = keyframe.id;
    place.keyframe_utime = last_utime_ = keyframe.utime;
    place.noise = keyframe.noise;
    const std::vector<PlanarRegion> regions = valid(keyframe.regions);
    place.sight = Sight(regions);
    place.planes = planes_of(regions);
    if (places_.size() > kMostPlaces) places_.pop_front();
}

/// Whether one more change may be said.
bool Looks::may_change(std::int64_t utime) {
    const double passed = static_cast<double>(utime - changed_utime_) * 1e-6;
    if (changed_utime_ != 0) changes_left_ += std::max(0.0, passed) / kChangeEach_s;
    changes_left_ = std::min(changes_left_, kMostChanges);
    changed_utime_ = utime;
    if (changes_left_ < 1) return false;
    changes_left_ -= 1;
    return true;
}

std::optional<Look> Looks::see(const OdometryEstimate& estimate, std::span<const PlanarRegion> all_regions) {
    if (estimate.status != TrackingStatus::kTracked || estimate.utime - last_utime_ < kLeastLookApart_us)
        return std::nullopt;
    const auto found = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
        return place.keyframe_id == estimate.keyframe_id;
    });
    std::vector<PlanarRegion> regions = valid(all_regions);
    if (found == places_.end() || regions.empty()) return std::nullopt;
    Place& place = *found;
    last_utime_ = estimate.utime;
    Sight sight(regions);
    std::vector<Plane> planes = planes_of(regions);
    const Pose now_from_before =
        estimate.keyframe_from_camera.inverse(Eigen::Isometry) * place.keyframe_from_camera;
    Look look;
    look.utime = estimate.utime;
    look.keyframe_id = place.keyframe_id;
    look.keyframe_utime = place.keyframe_utime;
    look.keyframe_from_camera = estimate.keyframe_from_camera;
    if (has_changed({place.sight, place.planes}, {sight, planes}, now_from_before, place.noise)) {
        if (!may_change(estimate.utime)) return std::nullopt;
        place.keyframe_from_camera = estimate.keyframe_from_camera;
        place.sight = sight;
        place.planes = std::move(planes);
        ++place.number;
        place.looks = 1;
        look.regions = std::move(regions);
    } else if (place.looks < kLooksThatCount || last_keyframe_id_ != place.keyframe_id) {
        place.looks = std::min(place.looks + 1, kLooksThatCount);
    } else {
        return std::nullopt;
    }
    last_keyframe_id_ = place.keyframe_id;
    look.number = place.number;
    look.looks = place.looks;
    return look;
}

}  // namespace planemap::odometry
