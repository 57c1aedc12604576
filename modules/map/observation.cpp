// SPDX-License-Identifier: BSD-3-Clause
#include "map/observation.hpp"

#include <cmath>

namespace planemap::map {

double ObservationModel::weight(const StoredRegion& region, const DepthNoise& noise) const {
    const double sigma = noise.sigma(mean_depth(region));
    const double pose_variance = pose_sigma_m * pose_sigma_m;
    return pose_variance / (pose_variance + sigma * sigma);
}

Reliability ObservationModel::reliability(const StoredRegion& region, const DepthNoise& noise) const {
    return {weight(region, noise), std::hypot(agreement_m, noise.sigma(mean_depth(region)))};
}

int ObservationModel::strength(const StoredRegion& region, const DepthNoise& noise) const {
    const double w = weight(region, noise);
    return w > 0.5 ? 2 : w > 0.2 ? 1 : 0;
}

}  // namespace planemap::map
