// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap {

/// A number by printf's pattern, e.g. "%.1f %%".
std::string format(const char* pattern, double value);

/// "812 B", "2.2 kB", "1.3 MB"; decimals of all but bytes.
std::string bytes_text(double bytes, int decimals = 1);

}  // namespace planemap
