// SPDX-License-Identifier: BSD-3-Clause
#include "graph/verification_options.hpp"

namespace planemap::graph {

places::VerificationOptions verification_options(const GraphOptions& options) {
    places::VerificationOptions out;
    out.matching = {options.max_descriptor_distance, options.matching_ratio};
    out.bearing_sigma = options.bearing_sigma;
    out.min_inliers = options.min_inliers;
    out.min_inlier_ratio = options.min_inlier_ratio;
    out.min_visible_ratio = options.min_visible_ratio;
    out.max_contradiction = options.max_contradiction;
    return out;
}

}  // namespace planemap::graph
