// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "segmentation/cells.hpp"
#include "segmentation/ransac.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

struct SegmentationOptions {
    std::string method = "cells";  ///< "cells", or "ransac" for the paper's method
    CellOptions cells;             ///< used by "cells"
    RansacOptions ransac;          ///< used by "ransac"
    std::uint64_t seed = 1;        ///< of the random samples of "ransac"

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// The segmenter that the options ask for; throws std::invalid_argument for bad options.
std::unique_ptr<Segmenter> make_segmenter(const SegmentationOptions& options);

}  // namespace planemap::segmentation
