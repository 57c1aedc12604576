// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration_kernels.inl"

namespace planemap {

const RegistrationKernels& baseline_registration_kernels() {
    static constexpr RegistrationKernels kKernels{"baseline", project, address};
    return kKernels;
}

const RegistrationKernels& best_registration_kernels() {
    const RegistrationKernels* avx2 = avx2_registration_kernels();
    return avx2 != nullptr ? *avx2 : baseline_registration_kernels();
}

}  // namespace planemap
