// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap::benchmark {

/// What the figures of a benchmark were measured with: CPU and its vector instructions, compiler, flags, the
/// `peers` with their versions, and a warning if this build is not one to measure. Lines that end with a
/// newline.
std::string build_info(const std::string& peers);

}  // namespace planemap::benchmark
