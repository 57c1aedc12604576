// SPDX-License-Identifier: BSD-3-Clause
// Timestamps as text: seconds, milliseconds, microseconds or nanoseconds, told apart by their size.
#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

namespace planemap {

/// Stamps are within this, either way: 36,000 years of microseconds. The difference of two does not overflow,
/// with any pause added.
constexpr std::int64_t kFarthestUtime = std::int64_t{1} << 60;

enum class StampUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// "12.345 s".
std::string seconds_text(std::int64_t us);

/// "seconds" and so on.
const char* unit_name(StampUnit unit);

/// A moment as names of files have it: 20261128-180501, UTC.
std::string date_text(std::time_t moment);

/// A moment as it was read.
struct Stamp {
    std::int64_t utime = 0;  ///< microseconds
    StampUnit unit = StampUnit::kSeconds;
};

/// Reads a decimal number, with a fraction or an exponent if it likes ("1311868164.363181", "1.31e+09"). Its
/// size says its unit: over 1e17 nanoseconds, over 1e14 microseconds, over 1e11 milliseconds, else seconds
/// (1e11 s is the year 5138, 1e11 ms is 1973). Exact to the microsecond, halves away from zero: the digits
/// never go through floating point. Nothing for anything else, and for what 64 bits of nanoseconds do not
/// hold.
std::optional<Stamp> read_stamp(std::string_view text);

/// Stamps of one column of a file: all of one unit.
class StampColumn {
  public:
    /// Microseconds. Throws std::runtime_error (reason only) for what is no stamp, or is of another unit than
    /// the first one.
    std::int64_t read(std::string_view text);
    /// Of the stamps so far; nothing before the first.
    std::optional<StampUnit> unit() const { return unit_; }

  private:
    std::optional<StampUnit> unit_;
    std::string first_;
};

}  // namespace planemap
