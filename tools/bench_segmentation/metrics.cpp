// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "bench_segmentation/local_normals.hpp"

namespace planemap::bench {

double tolerance(double z) {
    return std::max(0.015, 3 * DepthNoise{}.sigma(z));
}

FrameScore& FrameScore::operator+=(const FrameScore& o) {
    readings += o.readings;
    labelled += o.labelled;
    explained_pixels += o.explained_pixels;
    planar += o.planar;
    coherent_pixels += o.coherent_pixels;
    off30_pixels += o.off30_pixels;
    squared_distance += o.squared_distance;
    planes += o.planes;
    frames += o.frames;
    return *this;
}

double FrameScore::rms() const {
    return std::sqrt(share(squared_distance, labelled));
}

FrameScore score_frame(const DepthImage& depth, const CameraInfo& camera,
                       const Image<Eigen::Vector3f>& normals,
                       const segmentation::Segmentation& segmentation) {
    const Image<std::uint16_t>& labels = segmentation.labels;
    if (labels.width != depth.width || labels.height != depth.height)
        throw std::invalid_argument("label image is not as large as the depth image");
    const double cos20 = std::cos(std::numbers::pi / 9), cos30 = std::cos(std::numbers::pi / 6);
    FrameScore score;
    score.frames = 1;
    score.planes = static_cast<double>(segmentation.regions.size());
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            if (!is_trusted(depth(u, v), camera)) continue;
            score.readings += 1;
            const Eigen::Vector3d normal = normals(u, v).cast<double>();
            const bool planar = !normal.isZero();
            score.planar += planar;
            const std::uint16_t label = labels(u, v);
            if (label == 0) continue;
            if (label > segmentation.regions.size())
                throw std::invalid_argument("label " + std::to_string(label) + " has no region");
            const Plane& plane = segmentation.regions[label - 1u].plane;
            const double z = camera.metres(depth(u, v));
            const double distance = plane.signed_distance(camera.depth.unproject(u, v, z));
            const bool explained = std::abs(distance) <= tolerance(z);
            const double cosine = planar ? normal.dot(plane.normal) : 0;
            score.labelled += 1;
            score.explained_pixels += explained;
            score.coherent_pixels += planar && explained && cosine >= cos20;
            score.off30_pixels += planar && cosine < cos30;
            score.squared_distance += distance * distance;
        }
    }
    return score;
}

namespace {

double nearest_rank(std::vector<double> values, double share) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

double median(std::vector<double> values) {
    return nearest_rank(std::move(values), 0.5);
}

double percentile_95(std::vector<double> values) {
    return nearest_rank(std::move(values), 0.95);
}

}  // namespace planemap::bench
