// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_kernels.hpp"

namespace planemap::segmentation {

const CellKernels& best_cell_kernels() {
    const CellKernels* avx2 = avx2_cell_kernels();
    return avx2 != nullptr ? *avx2 : baseline_cell_kernels();
}

}  // namespace planemap::segmentation
