// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/option_list.hpp"
#include "segmentation/cells.hpp"
#include "segmentation/ransac.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// Options of a segmenter; options_of() says what each is.
struct SegmentationOptions {
    std::string method = "cells";
    CellOptions cells;     ///< used by "cells"
    RansacOptions ransac;  ///< used by "ransac"
    std::uint64_t seed = 1;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(SegmentationOptions& options);

/// The segmenter that the options ask for; throws std::invalid_argument for bad options.
std::unique_ptr<Segmenter> make_segmenter(const SegmentationOptions& options);

}  // namespace planemap::segmentation
