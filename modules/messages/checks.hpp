// SPDX-License-Identifier: BSD-3-Clause
// How conversions refuse a message.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "messages/error.hpp"

namespace planemap::messages {

[[noreturn]] inline void fail(const std::string& field, const std::string& reason) {
    throw MessageError(field + " " + reason);
}

inline void require(bool ok, const char* field, const char* reason) {
    if (!ok) fail(field, reason);
}

/// The number of elements as messages count them. Throws std::length_error when there are too many.
inline std::int32_t count32(std::size_t count) {
    if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
        throw std::length_error("message too long");
    return static_cast<std::int32_t>(count);
}

}  // namespace planemap::messages
