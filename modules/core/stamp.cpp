// SPDX-License-Identifier: BSD-3-Clause
#include "core/stamp.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "core/text_file.hpp"

namespace planemap {

namespace {

/// A decimal number: 0.DIGITS times ten to the power of `point`; the first digit is not 0, no digits are 0.
struct Decimal {
    bool negative = false;
    std::string digits;
    int point = 0;

    /// True when its size is over ten to the power of n.
    bool over(int n) const {
        if (digits.empty() || point != n + 1) return !digits.empty() && point > n + 1;
        return digits.find_first_not_of('0', 1) != std::string::npos || digits[0] != '1';
    }
    /// Times ten to the power of `shift` as a whole number, halves away from zero; nothing beyond 64 bits.
    std::optional<std::int64_t> whole(int shift) const;
};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

constexpr int kFarExponent = 100000;  // beyond any stamp, and far from an overflow

/// The exponent behind e; nothing unless it is a whole number.
std::optional<int> parse_exponent(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) return {};
    int value = 0;
    for (const char c : text) value = std::min(10 * value + (c - '0'), kFarExponent);
    return negative ? -value : value;
}

std::optional<Decimal> parse_decimal(std::string_view text) {
    Decimal number;
    number.negative = text.starts_with('-');
    if (number.negative || text.starts_with('+')) text.remove_prefix(1);
    const std::size_t mark = text.find_first_of("eE");
    const std::string_view mantissa = text.substr(0, mark);
    const std::size_t dot = std::min(mantissa.find('.'), mantissa.size());
    number.digits = mantissa.substr(0, dot);
    if (dot < mantissa.size()) number.digits += mantissa.substr(dot + 1);
    constexpr std::size_t kMostDigits = 1000;
    if (number.digits.empty() || number.digits.size() > kMostDigits ||
        !std::all_of(number.digits.begin(), number.digits.end(), is_digit)) {
        return {};
    }
    number.point = static_cast<int>(dot);
    if (mark != std::string_view::npos) {
        const auto exponent = parse_exponent(text.substr(mark + 1));
        if (!exponent) return {};
        number.point += *exponent;
    }
    const std::size_t zeros = std::min(number.digits.find_first_not_of('0'), number.digits.size());
    number.digits.erase(0, zeros);
    number.point -= static_cast<int>(zeros);
    return number;
}

std::optional<std::int64_t> Decimal::whole(int shift) const {
    constexpr int kDigitsOf64Bits = 19;
    const int count = point + shift;  // digits before the point
    if (digits.empty() || count < 0) return 0;
    if (count > kDigitsOf64Bits) return {};
    const auto digit = [&](int i) {
        return static_cast<std::size_t>(i) < digits.size() ? digits[static_cast<std::size_t>(i)] - '0' : 0;
    };
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = 10 * value + static_cast<std::uint64_t>(digit(i));
    if (digit(count) >= 5) ++value;
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
    const auto result = static_cast<std::int64_t>(value);
    return negative ? -result : result;
}

}  // namespace

const char* unit_name(StampUnit unit) {
    switch (unit) {
        case StampUnit::kSeconds:
            return "seconds";
        case StampUnit::kMilliseconds:
            return "milliseconds";
        case StampUnit::kMicroseconds:
            return "microseconds";
        case StampUnit::kNanoseconds:
            return "nanoseconds";
    }
    return "";
}

std::optional<Stamp> read_stamp(std::string_view text) {
    const std::optional<Decimal> number = parse_decimal(text);
    if (!number || !number->whole(0)) return {};
    Stamp stamp;
    int shift = 6;
    if (number->over(17)) {
        stamp.unit = StampUnit::kNanoseconds;
        shift = -3;
    } else if (number->over(14)) {
        stamp.unit = StampUnit::kMicroseconds;
        shift = 0;
    } else if (number->over(11)) {
        stamp.unit = StampUnit::kMilliseconds;
        shift = 3;
    }
    const auto utime = number->whole(shift);
    if (!utime) return {};
    stamp.utime = *utime;
    return stamp;
}

std::string seconds_text(std::int64_t us) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3f s", static_cast<double>(us) * 1e-6);
    return text;
}

std::int64_t StampColumn::read(std::string_view text) {
    const std::optional<Stamp> stamp = read_stamp(text);
    if (!stamp) {
        throw std::runtime_error(
            "\"" + shown_text(text) +
            "\" is no timestamp: a number of seconds, milliseconds, microseconds or nanoseconds");
    }
    if (!unit_) {
        unit_ = stamp->unit;
        first_ = text;
    }
    if (stamp->unit != *unit_) {
        throw std::runtime_error("by its size \"" + shown_text(text) + "\" is in " + unit_name(stamp->unit) +
                                 ", but the first timestamp, \"" + shown_text(first_) + "\", is in " +
                                 unit_name(*unit_));
    }
    return stamp->utime;
}

std::string date_text(std::time_t moment) {
    std::tm utc = {};
    ::gmtime_r(&moment, &utc);
    char text[32];
    std::strftime(text, sizeof(text), "%Y%m%d-%H%M%S", &utc);
    return text;
}

}  // namespace planemap
