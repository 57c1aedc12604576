// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planemap {

/// A number for people to read, with six significant digits. number_text() of option_list.hpp gives all of
/// them.
std::string short_number_text(double value);

}  // namespace planemap
