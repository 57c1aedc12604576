// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap {

/// A number by printf's pattern, e.g. "%.1f %%".
std::string format(const char* pattern, double value);

}  // namespace planemap
