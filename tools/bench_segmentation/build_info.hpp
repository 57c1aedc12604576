// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap::bench {

/// What the figures were measured with: CPU, compiler, flags, versions of the peers, and a warning if this
/// build is not one to measure. Lines that end with a newline.
std::string build_info();

}  // namespace planemap::bench
