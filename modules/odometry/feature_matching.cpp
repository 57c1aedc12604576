// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/feature_matching.hpp"

#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

PointTerm match_term(const Feature& seen, const Feature& here, const DepthNoise& noise) {
    const double z = here.point.z(), sigma = noise.sigma(z) / (z * z);
    return {seen.point.cast<double>(), here.pixel.cast<double>(), 2, 1 / z, 6 * sigma};
}

}  // namespace

void put_on_regions(std::vector<Feature>& features, const PreparedFrame& frame) {
    for (Feature& feature : features) {
        const Eigen::Vector3d point = feature.point.cast<double>();
        feature.region = region_of(frame.regions, point, frame.camera->noise.sigma(point.z()));
        if (feature.region < 0) continue;
        const Plane& plane = frame.regions[static_cast<std::size_t>(feature.region)].plane;
        feature.point = regularised(plane, point).cast<float>();
    }
}

std::vector<PointTerm> match_terms(std::span<const Feature> seen, std::span<const Feature> here,
                                   const PreparedFrame& frame, int max_distance) {
    std::vector<PointTerm> terms;
    for (const auto& [i, j] : match_descriptors(seen, here, max_distance))
        terms.push_back(match_term(seen[static_cast<std::size_t>(i)], here[static_cast<std::size_t>(j)],
                                   frame.camera->noise));
    return terms;
}

std::optional<Track> align_matches(const PinholeCamera& camera, std::span<const PointTerm> matches,
                                   const Pose& initial, int min_inliers) {
    Alignment alignment;
    alignment.camera = camera;
    alignment.points = matches;
    alignment.quadratics.push_back({initial, Matrix6d::Identity(), Twist::Zero(), true});
    Track track;
    track.alignment = align(alignment, initial);
    if (!track.alignment.converged || track.alignment.inliers < min_inliers) return std::nullopt;
    track.tried = static_cast<int>(matches.size());
    track.inliers = track.alignment.inliers;
    return track;
}

}  // namespace planemap::odometry
