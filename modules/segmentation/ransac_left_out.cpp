// SPDX-License-Identifier: BSD-3-Clause
// In ransac.cpp's place where planemap is built without PCL.
#include <stdexcept>

#include "segmentation/ransac.hpp"

namespace planemap::segmentation {

std::unique_ptr<Segmenter> make_ransac_segmenter(const RansacOptions& options, std::uint64_t) {
    options.validate();
    throw std::invalid_argument(
        "segmentation method 'ransac': this planemap was built without PCL (PLANEMAP_PCL=OFF); 'cells' needs "
        "none");
}

}  // namespace planemap::segmentation
