// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_kernels.inl"

namespace planemap::segmentation {

const CellKernels& baseline_cell_kernels() {
    static constexpr CellKernels kKernels{"baseline", fit, label, sum};
    return kKernels;
}

}  // namespace planemap::segmentation
