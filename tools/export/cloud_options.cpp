// SPDX-License-Identifier: BSD-3-Clause
#include "export/cloud_options.hpp"

namespace planemap {

OptionList options_of(CloudOptions& options) {
    OptionList list("Cloud");
    list.add("voxel_m", options.voxel_m, {0.001, 1}, "Side of the cubes of which each has at most one point");
    list.add("most", options.most, {1000, 1e7},
             "Most points; beyond, the cubes' sides are doubled until there are fewer");
    return list;
}

void CloudOptions::validate() const {
    check_options("CloudOptions", *this);
}

}  // namespace planemap
