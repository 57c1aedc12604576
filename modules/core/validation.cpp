// SPDX-License-Identifier: BSD-3-Clause
#include "core/validation.hpp"

#include <stdexcept>

#include "core/number_text.hpp"

namespace planemap {

void FieldErrors::require(bool ok, std::string_view field, double value, std::string_view allowed) {
    if (!ok) require(ok, field, short_number_text(value), allowed);
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
