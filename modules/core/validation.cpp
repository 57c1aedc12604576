// SPDX-License-Identifier: BSD-3-Clause
#include "core/validation.hpp"

#include <sstream>
#include <stdexcept>

namespace planemap {

void FieldErrors::require(bool ok, std::string_view field, double value, std::string_view allowed) {
    if (ok) return;
    std::ostringstream number;
    number << value;
    require(ok, field, number.str(), allowed);
}

void FieldErrors::require(bool ok, std::string_view field, std::string_view value, std::string_view allowed) {
    if (ok) return;
    if (!text_.empty()) text_ += "; ";
    text_.append(field).append(" is ").append(value).append(", must be ").append(allowed);
}

void FieldErrors::throw_if_any() const {
    if (any()) throw std::invalid_argument(what_ + ": " + text_);
}

}  // namespace planemap
