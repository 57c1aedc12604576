// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bench_segmentation/local_normals.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench {

namespace {

constexpr double kTolerance = 0.8;  // of IoU, and Hoover's

/// A true region: pieces of one surface that belong together, see MatchScore.
struct TrueRegion {
    double pixels = 0;
    int large_pieces = 0;  // of at least least_pixels: what it counts for
    Plane plane;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of its pixels, on its plane
};

/// How the pixels of an image fall on true and found regions.
struct Overlaps {
    std::vector<TrueRegion> truth;
    std::vector<double> found;                 // pixels of each found region
    std::vector<std::vector<double>> overlap;  // [true][found], pixels

    double iou(std::size_t t, std::size_t f) const {
        return overlap[t][f] / (truth[t].pixels + found[f] - overlap[t][f]);
    }
};

/// Pixels and sum of points of each piece, its pixels on each found region, and pixels of each found region.
struct Tally {
    std::vector<std::vector<double>> overlap;  // [piece][found]
    std::vector<Eigen::Vector3d> sum;          // of the points of each piece
    std::vector<double> found;
};

Tally tally(const Truth& truth, const segmentation::Segmentation& segmentation, const DepthImage& depth,
            const CameraInfo& camera) {
    const std::size_t regions = segmentation.regions.size();
    Tally tally{std::vector(truth.pieces.size(), std::vector<double>(regions)),
                std::vector<Eigen::Vector3d>(truth.pieces.size(), Eigen::Vector3d::Zero()),
                std::vector<double>(regions)};
    for_each_reading(depth, camera, [&](int u, int v, double z) {
        const std::size_t label = segmentation.labels(u, v), piece = truth.pieces_of_pixels(u, v);
        if (label > 0) tally.found[label - 1] += 1;
        if (piece == 0) return;
        tally.sum[piece - 1] += camera.depth.unproject(u, v, z);
        if (label > 0) tally.overlap[piece - 1][label - 1] += 1;
    });
    return tally;
}

/// Joins the pieces of a surface that the same found region covers by more than half each.
Overlaps join_pieces(const Truth& truth, const Tally& tally, double least_pixels) {
    Overlaps out;
    out.found = tally.found;
    std::map<std::pair<int, std::size_t>, std::size_t> joined;  // (surface, found region) to true region
    for (std::size_t p = 0; p < truth.pieces.size(); ++p) {
        const TruePiece& piece = truth.pieces[p];
        const auto most = std::max_element(tally.overlap[p].begin(), tally.overlap[p].end());
        std::size_t region = out.truth.size();
        if (most != tally.overlap[p].end() && 2 * *most > piece.pixels) {
            const auto found = static_cast<std::size_t>(most - tally.overlap[p].begin());
            region = joined.try_emplace({piece.surface, found}, region).first->second;
        }
        if (region == out.truth.size()) {
            out.truth.push_back({0, 0, piece.plane, {0, 0, 0}});
            out.overlap.emplace_back(out.found.size());
        }
        out.truth[region].pixels += piece.pixels;
        out.truth[region].large_pieces += piece.pixels >= least_pixels;
        out.truth[region].centroid += tally.sum[p];
        for (std::size_t f = 0; f < out.found.size(); ++f) out.overlap[region][f] += tally.overlap[p][f];
    }
    for (TrueRegion& region : out.truth)
        region.centroid = region.plane.project(region.centroid / region.pixels);
    return out;
}

void match_by_iou(const Overlaps& o, const segmentation::Segmentation& segmentation, double least_pixels,
                  MatchScore& score) {
    for (std::size_t f = 0; f < o.found.size(); ++f) score.found += o.found[f] >= least_pixels;
    for (std::size_t t = 0; t < o.truth.size(); ++t) {
        const TrueRegion& truth = o.truth[t];
        score.true_pieces += truth.large_pieces;
        for (std::size_t f = 0; f < o.found.size(); ++f) {
            if (o.overlap[t][f] == 0 || o.iou(t, f) < kTolerance) continue;
            const Plane& plane = segmentation.regions[f].plane;
            score.recalled += truth.large_pieces;
            score.precise += o.found[f] >= least_pixels;
            if (truth.large_pieces == 0) continue;
            score.angle_deg.push_back(degrees(angle_between(plane.normal, truth.plane.normal)));
            score.distance_m.push_back(std::abs(plane.signed_distance(truth.centroid)));
        }
    }
}

/// Hoover's instances of one kind: `whole` is split over at least two of `parts` that lie in it. `inside(i)`
/// is the overlap of part i with the whole.
template <typename Overlap>
std::vector<std::size_t> split_over(double whole, const std::vector<double>& parts,
                                    const std::vector<char>& taken, const Overlap& inside) {
    std::vector<std::size_t> members;
    double sum = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (taken[i] || parts[i] == 0 || inside(i) < kTolerance * parts[i]) continue;
        members.push_back(i);
        sum += inside(i);
    }
    if (members.size() < 2 || sum < kTolerance * whole) members.clear();
    return members;
}

void count_instances(const Overlaps& o, double least_pixels, MatchScore& score) {
    std::vector<char> true_taken(o.truth.size()), found_taken(o.found.size());
    std::vector<double> true_pixels;
    for (const TrueRegion& region : o.truth) true_pixels.push_back(region.pixels);
    for (std::size_t t = 0; t < o.truth.size(); ++t) {
        for (std::size_t f = 0; f < o.found.size(); ++f) {
            if (o.overlap[t][f] < kTolerance * std::max(true_pixels[t], o.found[f])) continue;
            score.correct += o.truth[t].large_pieces;
            true_taken[t] = found_taken[f] = 1;
        }
    }
    for (std::size_t t = 0; t < o.truth.size(); ++t) {
        if (true_taken[t]) continue;
        const auto members =
            split_over(true_pixels[t], o.found, found_taken, [&](std::size_t f) { return o.overlap[t][f]; });
        if (members.empty()) continue;
        score.over_segmented += o.truth[t].large_pieces;
        true_taken[t] = 1;
        for (const std::size_t f : members) found_taken[f] = 1;
    }
    for (std::size_t f = 0; f < o.found.size(); ++f) {
        if (found_taken[f]) continue;
        const auto members =
            split_over(o.found[f], true_pixels, true_taken, [&](std::size_t t) { return o.overlap[t][f]; });
        for (const std::size_t t : members) {
            score.under_segmented += o.truth[t].large_pieces;
            true_taken[t] = found_taken[f] = 1;
        }
    }
    for (std::size_t t = 0; t < o.truth.size(); ++t)
        score.missed += true_taken[t] ? 0 : o.truth[t].large_pieces;
    for (std::size_t f = 0; f < o.found.size(); ++f)
        score.noise += !found_taken[f] && o.found[f] >= least_pixels;
}

}  // namespace

Truth make_truth(const Image<std::uint16_t>& surfaces, const std::vector<Plane>& planes,
                 const DepthImage& depth, const CameraInfo& camera) {
    Truth truth;
    truth.pieces_of_pixels = Image<std::uint16_t>(depth.width, depth.height);
    std::vector<std::pair<int, int>> stack;
    const auto open = [&](int u, int v, std::uint16_t surface) {
        return surfaces.contains(u, v) && surfaces(u, v) == surface && truth.pieces_of_pixels(u, v) == 0 &&
               is_trusted(depth(u, v), camera);
    };
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const std::uint16_t surface = surfaces(u, v);
            if (surface == 0 || !open(u, v, surface)) continue;
            if (truth.pieces.size() == std::numeric_limits<std::uint16_t>::max()) return truth;
            TruePiece piece{surface - 1, 0, planes.at(surface - 1u)};
            const auto name = static_cast<std::uint16_t>(truth.pieces.size() + 1);
            const auto take = [&](int x, int y) {
                if (!open(x, y, surface)) return;
                truth.pieces_of_pixels(x, y) = name;
                piece.pixels += 1;
                stack.emplace_back(x, y);
            };
            take(u, v);
            while (!stack.empty()) {
                const auto [x, y] = stack.back();
                stack.pop_back();
                take(x + 1, y), take(x - 1, y), take(x, y + 1), take(x, y - 1);
            }
            truth.pieces.push_back(piece);
        }
    }
    return truth;
}

MatchScore& MatchScore::operator+=(const MatchScore& o) {
    true_pieces += o.true_pieces;
    recalled += o.recalled;
    found += o.found;
    precise += o.precise;
    correct += o.correct;
    over_segmented += o.over_segmented;
    under_segmented += o.under_segmented;
    missed += o.missed;
    noise += o.noise;
    angle_deg.insert(angle_deg.end(), o.angle_deg.begin(), o.angle_deg.end());
    distance_m.insert(distance_m.end(), o.distance_m.begin(), o.distance_m.end());
    return *this;
}

MatchScore match(const Truth& truth, const segmentation::Segmentation& segmentation, const DepthImage& depth,
                 const CameraInfo& camera, double least_pixels) {
    const Overlaps overlaps = join_pieces(truth, tally(truth, segmentation, depth, camera), least_pixels);
    MatchScore score;
    match_by_iou(overlaps, segmentation, least_pixels, score);
    count_instances(overlaps, least_pixels, score);
    return score;
}

}  // namespace planemap::bench
