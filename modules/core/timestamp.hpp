// SPDX-License-Identifier: BSD-3-Clause
// Timestamps as files write them, in whole microseconds as messages hold them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace planemap {

enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// "s", "ms", "us" or "ns".
const char* unit_name(TimeUnit unit);

/// The unit of a timestamp since the epoch, by its size: above 1e17 nanoseconds, above 1e14 microseconds,
/// above 1e11 milliseconds, else seconds.
TimeUnit time_unit_of(double timestamp);

/// A decimal number in the unit (sign, point and exponent allowed) as microseconds, rounded half away from
/// zero, in whole numbers: no digit is lost on the way. Nothing for what is no such number, or beyond 64
/// bits.
std::optional<std::int64_t> timestamp_us(std::string_view text, TimeUnit unit);

}  // namespace planemap
