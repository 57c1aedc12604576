// SPDX-License-Identifier: BSD-3-Clause
#define PLANEMAP_PORTABLE_LANES
#include "segmentation/cell_kernels.inl"

namespace planemap::segmentation {

const CellKernels& portable_cell_kernels() {
    static constexpr CellKernels kKernels{"portable", fit, label, sum};
    return kKernels;
}

}  // namespace planemap::segmentation
