// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

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
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const std::uint16_t label = segmentation.labels(u, v);
            if (label == 0 || !is_trusted(depth(u, v), camera)) continue;
            sightings[label - 1u].centroid += camera.depth.unproject(u, v, camera.metres(depth(u, v)));
            sightings[label - 1u].pixels += 1;
        }
    }
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        Sighting& sighting = sightings[i];
        if (sighting.pixels < least_pixels(depth)) continue;
        const Plane& plane = segmentation.regions[i].plane;
        sighting.plane = world_from_depth * plane;
        sighting.centroid = world_from_depth * plane.project(sighting.centroid / sighting.pixels);
        world_planes.add(sighting);
    }
}

std::string format(const char* pattern, double value, bool known = true) {
    char text[32];
    if (!known || !std::isfinite(value)) {
        std::snprintf(text, sizeof(text), pattern, 0.0);
        return std::string(std::string(text).size() - 1, ' ') + "-";
    }
    std::snprintf(text, sizeof(text), pattern, value);
    return text;
}

/// JSON has no NaN.
nlohmann::ordered_json number(double value, bool known = true) {
    if (!known || !std::isfinite(value)) return nullptr;
    return value;
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

std::string table_heading() {
    return "method              sub frames       ms      p95  planes  expl%   coh%  off30%  rms mm |"
           "  rec%  prec%  corr  over under  miss noise    deg     mm | spread deg    mm\n";
}

std::string table_line(const Row& row) {
    char name[64];
    std::snprintf(name, sizeof(name), "%-19s %3d %6.0f", row.method.name.c_str(), row.method.subsampling,
                  row.score.frames);
    const FrameScore& s = row.score;
    const MatchScore& m = row.match;
    const bool truth = row.has_truth;
    const Spread spread = row.world_planes.spread_of_largest(kLargestPlanes);
    const bool poses = row.has_poses && spread.planes > 0;
    return name + format(" %8.3f", median(row.ms)) + format(" %8.3f", percentile_95(row.ms)) +
           format(" %7.1f", s.planes_a_frame()) + format(" %6.1f", 100 * s.explained()) +
           format(" %6.1f", 100 * s.coherent()) + format(" %7.2f", 100 * s.off30()) +
           format(" %7.2f", 1e3 * s.rms()) + " |" +
           format(" %5.1f", 100 * m.recall(), truth && m.true_pieces > 0) +
           format(" %6.1f", 100 * m.precision(), truth && m.found > 0) + format(" %5.0f", m.correct, truth) +
           format(" %5.0f", m.over_segmented, truth) + format(" %5.0f", m.under_segmented, truth) +
           format(" %5.0f", m.missed, truth) + format(" %5.0f", m.noise, truth) +
           format(" %6.3f", median(m.angle_deg), truth) +
           format(" %6.2f", 1e3 * median(m.distance_m), truth) + " |" +
           format(" %10.3f", spread.angle_deg, poses) + format(" %5.1f", 1e3 * spread.distance_m, poses) +
           "\n";
}

nlohmann::ordered_json to_json(const Row& row) {
    const FrameScore& s = row.score;
    const MatchScore& m = row.match;
    const bool truth = row.has_truth;
    const Spread spread = row.world_planes.spread_of_largest(kLargestPlanes);
    const bool poses = row.has_poses && spread.planes > 0;
    return {{"sequence", row.sequence},
            {"method", row.method.name},
            {"subsampling", row.method.subsampling},
            {"frames", static_cast<int>(s.frames)},
            {"median_ms", number(median(row.ms))},
            {"p95_ms", number(percentile_95(row.ms))},
            {"max_ms", number(row.ms.empty() ? NAN : *std::max_element(row.ms.begin(), row.ms.end()))},
            {"planes", s.planes_a_frame()},
            {"explained", s.explained()},
            {"coherent", s.coherent()},
            {"off30", s.off30()},
            {"rms_m", s.rms()},
            {"recall", number(m.recall(), truth && m.true_pieces > 0)},
            {"precision", number(m.precision(), truth && m.found > 0)},
            {"angle_median_deg", number(median(m.angle_deg), truth)},
            {"distance_median_m", number(median(m.distance_m), truth)},
            {"true_regions", number(m.true_pieces, truth)},
            {"correct", number(m.correct, truth)},
            {"over_segmented", number(m.over_segmented, truth)},
            {"under_segmented", number(m.under_segmented, truth)},
            {"missed", number(m.missed, truth)},
            {"noise", number(m.noise, truth)},
            {"spread_planes", number(spread.planes, poses)},
            {"spread_angle_deg", number(spread.angle_deg, poses)},
            {"spread_distance_m", number(spread.distance_m, poses)}};
}

}  // namespace planemap::bench
