// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 on x86 (see CMakeLists.txt), and not called where the machine lacks it.
#ifdef __AVX2__
#include "segmentation/cell_kernels.inl"
#else
#include "segmentation/cell_kernels.hpp"
#endif

namespace planemap::segmentation {

const CellKernels* avx2_cell_kernels() {
#ifdef __AVX2__
    static constexpr CellKernels kKernels{"avx2", fit, label, sum};
    return __builtin_cpu_supports("avx2") ? &kKernels : nullptr;
#else
    return nullptr;
#endif
}

}  // namespace planemap::segmentation
