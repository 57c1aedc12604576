// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace planemap::messages {

/// Wall clock, microseconds since the epoch.
std::int64_t now_us();

}  // namespace planemap::messages
