// SPDX-License-Identifier: BSD-3-Clause
#include "core/number_text.hpp"

#include <cstdio>

namespace planemap {

std::string short_number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.6g", value);
    return text;
}

}  // namespace planemap
