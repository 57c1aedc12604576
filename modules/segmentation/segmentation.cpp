// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation.hpp"

#include "core/validation.hpp"

namespace planemap::segmentation {

void SegmentationOptions::validate() const {
    FieldErrors errors("segmentation options");
    errors.require(method == "cells" || method == "ransac", "method", method, "\"cells\" or \"ransac\"");
    cells.check("cells.", errors);
    ransac.check("ransac.", errors);
    errors.throw_if_any();
}

std::unique_ptr<Segmenter> make_segmenter(const SegmentationOptions& options) {
    options.validate();
    if (options.method == "ransac") return make_ransac_segmenter(options.ransac, options.seed);
    return make_cell_segmenter(options.cells);
}

}  // namespace planemap::segmentation
