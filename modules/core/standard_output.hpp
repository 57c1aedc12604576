// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace planemap {

/// Writes to standard output and sees it through. Throws std::runtime_error if it cannot be written, e.g. to
/// a full disk.
void print(std::string_view text);

/// Sees through what was printed by other means, e.g. a table, in the same way.
void finish_printing();

}  // namespace planemap
