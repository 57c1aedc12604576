// SPDX-License-Identifier: BSD-3-Clause
#include "core/version.hpp"

namespace planemap {

const char* version() {
    return PLANEMAP_VERSION;
}

}  // namespace planemap
