// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "core/option_list.hpp"

namespace planemap::octomap {

/// Options of OctomapBuilder; options_of() says what each is.
struct OctomapOptions {
    double resolution_m = 0.05;
    double max_range_m = 0;
    int subsample = 1;
    std::size_t max_keyframes = 2000;
    double moved_m = 0.002;
    double moved_deg = 0.05;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(OctomapOptions& options);

}  // namespace planemap::octomap
