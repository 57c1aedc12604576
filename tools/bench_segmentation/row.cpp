// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/row.hpp"

#include <algorithm>
#include <cmath>

#include "bench_segmentation/local_normals.hpp"

namespace planemap::bench {

namespace {

constexpr double kLeastShare = 1000.0 / (640 * 480);  // of the image: a region that counts
constexpr int kLargestPlanes = 5;

double least_pixels(const DepthImage& depth) {
    return kLeastShare * depth.width * depth.height;
}

/// The regions that count, in the world.
void add_sightings(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_depth,
                   const segmentation::Segmentation& segmentation, WorldPlanes& world_planes) {
    std::vector<Sighting> sightings(segmentation.regions.size());
    for_each_reading(depth, camera, [&](int u, int v, double z) {
        const std::uint16_t label = segmentation.labels(u, v);
        if (label == 0) return;
        sightings[label - 1u].centroid += camera.depth.unproject(u, v, z);
        sightings[label - 1u].pixels += 1;
    });
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        Sighting& sighting = sightings[i];
        if (sighting.pixels < least_pixels(depth)) continue;
        const Plane& plane = segmentation.regions[i].plane;
        sighting.plane = world_from_depth * plane;
        sighting.centroid = world_from_depth * plane.project(sighting.centroid / sighting.pixels);
        world_planes.add(sighting);
    }
}

Json known_if(bool is_known, double value) {
    return is_known ? results::number(value) : Json(nullptr);
}

}  // namespace

void Row::add(std::optional<double> frame_ms, const BenchFrame& frame, const CameraInfo& camera,
              const Image<Eigen::Vector3f>& normals, const segmentation::Segmentation& segmentation) {
    if (frame_ms) ms.push_back(*frame_ms);
    score += score_frame(frame.depth, camera, normals, segmentation);
    if (frame.truth) {
        has_truth = true;
        match += bench::match(*frame.truth, segmentation, frame.depth, camera, least_pixels(frame.depth));
    }
    if (frame.world_from_depth) {
        has_poses = true;
        add_sightings(frame.depth, camera, *frame.world_from_depth, segmentation, world_planes);
    }
}

const results::Table& table() {
    using results::kBar;
    using results::milli;
    using results::percent;
    static const results::Table kTable{{"method", "method", -19},
                                       {"sub", "subsampling", 3},
                                       {"frames", "frames", 6},
                                       {"ms", "median_ms", 8, 3},
                                       {"p95", "p95_ms", 8, 3},
                                       {"planes", "planes", 7, 1},
                                       {"expl%", "explained", 6, 1, percent},
                                       {"coh%", "coherent", 6, 1, percent},
                                       {"off30%", "off30", 7, 2, percent},
                                       {"rms mm", "rms_m", 7, 2, milli},
                                       kBar,
                                       {"rec%", "recall", 5, 1, percent},
                                       {"prec%", "precision", 6, 1, percent},
                                       {"corr", "correct", 5},
                                       {"over", "over_segmented", 5},
                                       {"under", "under_segmented", 5},
                                       {"miss", "missed", 5},
                                       {"noise", "noise", 5},
                                       {"deg", "angle_median_deg", 6, 3},
                                       {"mm", "distance_median_m", 6, 2, milli},
                                       kBar,
                                       {"spread deg", "spread_angle_deg", 10, 3},
                                       {"mm", "spread_distance_m", 5, 1, milli}};
    return kTable;
}

Json to_json(const Row& row) {
    const FrameScore& s = row.score;
    const MatchScore& m = row.match;
    const bool truth = row.has_truth;
    const Spread spread = row.world_planes.spread_of_largest(kLargestPlanes);
    const bool poses = row.has_poses && spread.planes > 0;
    return {
        {"sequence", row.sequence},
        {"method", row.method.name},
        {"subsampling", row.method.subsampling},
        {"frames", static_cast<int>(s.frames)},
        {"median_ms", results::number(median(row.ms))},
        {"p95_ms", results::number(percentile_95(row.ms))},
        {"max_ms", results::number(row.ms.empty() ? NAN : *std::max_element(row.ms.begin(), row.ms.end()))},
        {"planes", s.planes_a_frame()},
        {"explained", s.explained()},
        {"coherent", s.coherent()},
        {"off30", s.off30()},
        {"rms_m", s.rms()},
        {"recall", known_if(truth && m.true_pieces > 0, m.recall())},
        {"precision", known_if(truth && m.found > 0, m.precision())},
        {"angle_median_deg", known_if(truth, median(m.angle_deg))},
        {"distance_median_m", known_if(truth, median(m.distance_m))},
        {"true_regions", known_if(truth, m.true_pieces)},
        {"correct", known_if(truth, m.correct)},
        {"over_segmented", known_if(truth, m.over_segmented)},
        {"under_segmented", known_if(truth, m.under_segmented)},
        {"missed", known_if(truth, m.missed)},
        {"noise", known_if(truth, m.noise)},
        {"spread_planes", known_if(poses, spread.planes)},
        {"spread_angle_deg", known_if(poses, spread.angle_deg)},
        {"spread_distance_m", known_if(poses, spread.distance_m)}};
}

}  // namespace planemap::bench
