// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bench_segmentation/local_normals.hpp"
#include "core/geometry/angle.hpp"

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
    return std::sqrt(share(squared_distance, labelled).value_or(0));
}

FrameScore score_frame(const DepthImage& depth, const CameraInfo& camera,
                       const Image<Eigen::Vector3f>& normals,
                       const segmentation::Segmentation& segmentation) {
    const Image<std::uint16_t>& labels = segmentation.labels;
    if (labels.width != depth.width || labels.height != depth.height)
        throw std::invalid_argument("label image is not as large as the depth image");
    const double cos20 = std::cos(radians(20)), cos30 = std::cos(radians(30));
    FrameScore score;
    score.frames = 1;
    score.planes = static_cast<double>(segmentation.regions.size());
    for_each_reading(depth, camera, [&](int u, int v, double z) {
        score.readings += 1;
        const Eigen::Vector3d normal = normals(u, v).cast<double>();
        const bool planar = !normal.isZero();
        score.planar += planar;
        const std::uint16_t label = labels(u, v);
        if (label == 0) return;
        if (label > segmentation.regions.size())
            throw std::invalid_argument("label " + std::to_string(label) + " has no region");
        const Plane& plane = segmentation.regions[label - 1u].plane;
        const double distance = plane.signed_distance(camera.depth.unproject(u, v, z));
        const bool explained = std::abs(distance) <= tolerance(z);
        const double cosine = planar ? normal.dot(plane.normal) : 0;
        score.labelled += 1;
        score.explained_pixels += explained;
        score.coherent_pixels += planar && explained && cosine >= cos20;
        score.off30_pixels += planar && cosine < cos30;
        score.squared_distance += distance * distance;
    });
    return score;
}

double median(std::vector<double> values) {
    return nearest_rank(std::move(values), 0.5);
}

double percentile_95(std::vector<double> values) {
    return nearest_rank(std::move(values), 0.95);
}

}  // namespace planemap::bench
