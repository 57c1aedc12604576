// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {

std::unique_ptr<Segmenter> make_segmenter(const SegmentationOptions& options) {
    options.validate();
    if (options.method == "ransac") return make_ransac_segmenter(options.ransac, options.seed);
    return make_cell_segmenter(options.cells);
}

}  // namespace planemap::segmentation
