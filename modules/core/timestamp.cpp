// SPDX-License-Identifier: BSD-3-Clause
#include "core/timestamp.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace planemap {

namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// 0.digits times ten to the power of `point`.
struct Decimal {
    bool negative = false;
    std::string digits;  ///< without leading zeros
    long point = 0;
};

std::optional<Decimal> parse_decimal(std::string_view text) {
    Decimal decimal;
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
        decimal.negative = text[0] == '-';
        text.remove_prefix(1);
    }
    bool any = false, after_point = false;
    while (!text.empty() && (is_digit(text[0]) || (text[0] == '.' && !after_point))) {
        const char c = text[0];
        text.remove_prefix(1);
        if (c == '.') {
            after_point = true;
            continue;
        }
        any = true;
        const bool leading_zero = c == '0' && decimal.digits.empty();
        if (!leading_zero) decimal.digits += c;
        if (!leading_zero && !after_point) ++decimal.point;
        if (leading_zero && after_point) --decimal.point;
    }
    if (!any) return std::nullopt;
    if (!text.empty() && (text[0] == 'e' || text[0] == 'E')) {
        text.remove_prefix(1);
        if (!text.empty() && text[0] == '+') text.remove_prefix(1);
        int exponent = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
        if (error != std::errc()) return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
        decimal.point += exponent;
    }
    if (!text.empty()) return std::nullopt;
    return decimal;
}

}  // namespace

const char* unit_name(TimeUnit unit) {
    switch (unit) {
        case TimeUnit::kSeconds:
            return "s";
        case TimeUnit::kMilliseconds:
            return "ms";
        case TimeUnit::kMicroseconds:
            return "us";
        case TimeUnit::kNanoseconds:
            return "ns";
    }
    return "?";
}

TimeUnit time_unit_of(double timestamp) {
    const double size = std::abs(timestamp);
    if (size > 1e17) return TimeUnit::kNanoseconds;
    if (size > 1e14) return TimeUnit::kMicroseconds;
    if (size > 1e11) return TimeUnit::kMilliseconds;
    return TimeUnit::kSeconds;
}

std::optional<std::int64_t> timestamp_us(std::string_view text, TimeUnit unit) {
    auto decimal = parse_decimal(text);
    if (!decimal) return std::nullopt;
    if (decimal->digits.empty()) return 0;
    const long whole_digits = decimal->point + (unit == TimeUnit::kSeconds        ? 6
                                                : unit == TimeUnit::kMilliseconds ? 3
                                                : unit == TimeUnit::kMicroseconds ? 0
                                                                                  : -3);
    if (whole_digits > 19) return std::nullopt;  // 64 bits hold 19 digits
    if (whole_digits < 0) return 0;
    const auto whole = static_cast<std::size_t>(whole_digits);
    const bool up = decimal->digits.size() > whole && decimal->digits[whole] >= '5';
    decimal->digits.resize(whole, '0');
    std::uint64_t value = up ? 1 : 0;
    std::uint64_t scale = 1;
    for (std::size_t i = whole; i-- > 0; scale *= 10)
        value += scale * static_cast<std::uint64_t>(decimal->digits[i] - '0');
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return std::nullopt;
    const auto magnitude = static_cast<std::int64_t>(value);
    return decimal->negative ? -magnitude : magnitude;
}

}  // namespace planemap
