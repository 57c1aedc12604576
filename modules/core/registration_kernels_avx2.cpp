// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 on x86 (see CMakeLists.txt), and not called where the machine lacks it.
#ifdef __AVX2__
#include "core/registration_kernels.inl"
#else
#include "core/registration_kernels.hpp"
#endif

namespace planemap {

const RegistrationKernels* avx2_registration_kernels() {
#ifdef __AVX2__
    static constexpr RegistrationKernels kKernels{"avx2", project, address};
    return __builtin_cpu_supports("avx2") ? &kKernels : nullptr;
#else
    return nullptr;
#endif
}

}  // namespace planemap
