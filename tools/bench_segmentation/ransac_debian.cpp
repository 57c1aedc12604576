// SPDX-License-Identifier: BSD-3-Clause
// The project's ransac once more, in a shared library of its own, but with the templates that Debian's PCL
// library holds: here PCL's headers come first and without PCL_NO_PRECOMPILE, so that they only declare, and
// what the source defines later has no effect. This library's names are hidden, and the benchmark hides those
// of its own instantiations, so that neither takes the other's.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include "segmentation/ransac.cpp"  // NOLINT(bugprone-suspicious-include): the same source, see above

namespace planemap::bench {

__attribute__((visibility("default"))) std::unique_ptr<segmentation::Segmenter> make_debian_ransac_segmenter(
    const segmentation::RansacOptions& options, std::uint64_t seed);

std::unique_ptr<segmentation::Segmenter> make_debian_ransac_segmenter(
    const segmentation::RansacOptions& options, std::uint64_t seed) {
    return segmentation::make_ransac_segmenter(options, seed);
}

}  // namespace planemap::bench
