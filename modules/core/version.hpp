// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace planemap {

/// planemap's version as CMake's project() says it: "0.1.0".
const char* version();

}  // namespace planemap
