// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap {

/// docs/options.md: every option of every module in tables, from the lists that flags and checks come from.
std::string options_document();

}  // namespace planemap
