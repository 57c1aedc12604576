// SPDX-License-Identifier: BSD-3-Clause
// The methods that are compared.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmark/plane_finder.hpp"

namespace planemap::bench {

/// A method at one subsampling.
struct MethodName {
    std::string name;
    int subsampling = 1;
    friend bool operator==(const MethodName&, const MethodName&) = default;
};

/// What there is to know of a method.
struct MethodInfo {
    std::string name;
    std::string what;                    ///< one line for --help and the header
    std::vector<int> subsamplings;       ///< run by default
    std::vector<int> slow_subsamplings;  ///< of these: on fewer frames
};
const std::vector<MethodInfo>& known_methods();

/// True for a method that is run on fewer frames.
bool is_slow(const MethodName& method);

/// Reads "cells,ransac/4": names, each with one subsampling from 1 to 16 or with the method's own. Throws
/// std::invalid_argument that names what is wrong and lists what there is.
std::vector<MethodName> parse_methods(const std::string& list);

/// Labels of a decimated image spread to the full one: each pixel takes the label of the nearest sample where
/// its reading is trusted and lies within tolerance() of that label's plane.
Image<std::uint16_t> spread(const Image<std::uint16_t>& labels, const std::vector<PlanarRegion>& regions,
                            const DepthImage& depth, const CameraInfo& camera, int step);

/// A method, ready to run frame after frame.
class Method {
  public:
    explicit Method(const MethodName& name);

    /// Finds the planes; returns the thread's CPU time in milliseconds, decimation included.
    double run(const DepthImage& depth, const CameraInfo& camera);
    /// What the last run() found, labels in the full size. Not part of the time.
    const segmentation::Segmentation& result(const DepthImage& depth, const CameraInfo& camera);

  private:
    std::unique_ptr<benchmark::Finder> finder_;
    int step_ = 1;  // of our decimation; 1 where the method itself subsamples
    segmentation::Segmentation segmentation_;
};

}  // namespace planemap::bench
