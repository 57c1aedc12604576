// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/consistency.hpp"

#include <algorithm>
#include <cmath>

#include "bench_segmentation/metrics.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench {

namespace {

constexpr double kMaxAngle = radians(10), kMaxDistance_m = 0.1;

}  // namespace

Plane WorldPlanes::WorldPlane::mean() const {
    const Eigen::Vector3d normal = normal_sum.normalized();
    return {normal, -normal.dot(centroid_sum / pixels)};
}

void WorldPlanes::add(const Sighting& sighting) {
    WorldPlane* nearest = nullptr;
    double least = kMaxDistance_m;
    for (WorldPlane& plane : planes_) {
        const Plane mean = plane.mean();
        const double distance = std::abs(mean.signed_distance(sighting.centroid));
        if (distance > least || angle_between(mean.normal, sighting.plane.normal) > kMaxAngle) continue;
        nearest = &plane;
        least = distance;
    }
    WorldPlane& plane = nearest != nullptr ? *nearest : planes_.emplace_back();
    plane.sightings.push_back(sighting);
    plane.normal_sum += sighting.pixels * sighting.plane.normal;
    plane.centroid_sum += sighting.pixels * sighting.centroid;
    plane.pixels += sighting.pixels;
}

Spread WorldPlanes::spread(const WorldPlane& plane) {
    const Plane mean = plane.mean();
    double angle = 0, sum = 0, squares = 0;
    for (const Sighting& sighting : plane.sightings) {
        const double distance = mean.signed_distance(sighting.centroid);
        const double weight = sighting.pixels / plane.pixels;
        angle += weight * std::pow(angle_between(mean.normal, sighting.plane.normal), 2);
        sum += weight * distance;
        squares += weight * distance * distance;
    }
    return {1, degrees(std::sqrt(angle)), std::sqrt(std::max(0.0, squares - sum * sum))};
}

Spread WorldPlanes::spread_of_largest(int count) const {
    std::vector<const WorldPlane*> largest;
    for (const WorldPlane& plane : planes_) {
        if (plane.sightings.size() >= 3) largest.push_back(&plane);
    }
    std::sort(largest.begin(), largest.end(),
              [](const WorldPlane* a, const WorldPlane* b) { return a->pixels > b->pixels; });
    if (largest.size() > static_cast<std::size_t>(count)) largest.resize(static_cast<std::size_t>(count));
    if (largest.empty()) return {};
    std::vector<double> angles, distances;
    for (const WorldPlane* plane : largest) {
        const Spread one = spread(*plane);
        angles.push_back(one.angle_deg);
        distances.push_back(one.distance_m);
    }
    return {static_cast<int>(largest.size()), median(angles), median(distances)};
}

}  // namespace planemap::bench
