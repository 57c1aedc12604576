// SPDX-License-Identifier: BSD-3-Clause
#include "graph/verification_options.hpp"

namespace planemap::graph {

places::VerificationOptions verification_options(const GraphOptions& options) {
    places::VerificationOptions out;
    out.matching.ratio = options.matching_ratio;
    out.min_inliers = options.min_inliers;
    out.min_inlier_ratio = options.min_inlier_ratio;
    return out;
}

}  // namespace planemap::graph
