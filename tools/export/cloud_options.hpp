// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/option_list.hpp"

namespace planemap {

struct CloudOptions {
    double voxel_m = 0.02;  ///< side of the cubes of which each has one point
    int most = 2000000;     ///< points; beyond, cubes grow to twice their side until there are fewer

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};
OptionList options_of(CloudOptions& options);

}  // namespace planemap
