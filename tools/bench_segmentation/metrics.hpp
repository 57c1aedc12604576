// SPDX-License-Identifier: BSD-3-Clause
// How well a segmentation describes its depth image; no truth needed.
#pragma once

#include "evaluate/statistics.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::bench {

/// How far a pixel may lie from the plane whose label it carries to be explained by it: max(1.5 cm, 3
/// sigma(z)), metres, with sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2 whatever the sensor.
double tolerance(double z);

/// Counts of pixels, so that the figures of frames add up to the figures of a sequence. "Readings" are
/// trusted ones (see is_trusted()), "locally planar" is local_normals()'s.
struct FrameScore {
    double readings = 0;          ///< pixels with a trusted reading
    double labelled = 0;          ///< of these: with a label
    double explained_pixels = 0;  ///< of these: within tolerance() of the label's plane
    double planar = 0;            ///< locally planar pixels
    double coherent_pixels = 0;   ///< of these: explained by a plane within 20 deg of the local normal
    double off30_pixels = 0;      ///< locally planar, labelled: its plane is more than 30 deg off
    double squared_distance = 0;  ///< sum over labelled pixels of the squared distance to the plane, m^2
    double planes = 0, frames = 0;

    FrameScore& operator+=(const FrameScore& o);
    // 0 for a part of nothing.
    double explained() const { return share(explained_pixels, readings).value_or(0); }
    double coherent() const { return share(coherent_pixels, planar).value_or(0); }
    double off30() const { return share(off30_pixels, labelled).value_or(0); }
    /// Of the labelled pixels to their planes, metres.
    double rms() const;
    double planes_a_frame() const { return share(planes, frames).value_or(0); }
};

/// Scores one frame. Distances are of points to planes, orthogonal. Every region counts as a plane, whatever
/// its size. `normals` are the frame's local_normals(). Labels on pixels without a trusted reading are
/// ignored. Throws std::invalid_argument when the label image has not the depth image's size or a label has
/// no region.
FrameScore score_frame(const DepthImage& depth, const CameraInfo& camera,
                       const Image<Eigen::Vector3f>& normals, const segmentation::Segmentation& segmentation);

/// Median and 95th percentile by the nearest rank of sorted values; NaN for none.
double median(std::vector<double> values);
double percentile_95(std::vector<double> values);

}  // namespace planemap::bench
