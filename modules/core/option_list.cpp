// SPDX-License-Identifier: BSD-3-Clause
#include "core/option_list.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace planemap {

namespace {

/// The last that fits counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kUnits{{{"_m", "m"},
                                                                                {"_per_m", "1/m"},
                                                                                {"_m2", "m^2"},
                                                                                {"_deg", "deg"},
                                                                                {"_rad", "rad"},
                                                                                {"_px", "px"},
                                                                                {"_s", "s"},
                                                                                {"_m_s", "m/s"},
                                                                                {"_deg_s", "deg/s"},
                                                                                {"_hz", "Hz"},
                                                                                {"_sigmas", "sigmas"}}};

}  // namespace

std::string_view unit_of(std::string_view name) {
    std::string_view unit;
    for (const auto& [suffix, meaning] : kUnits)
        if (name.ends_with(suffix)) unit = meaning;
    return unit;
}

std::string number_text(double value) {
    std::array<char, 64> digits;
    const bool whole = std::abs(value) < 1e15 && value == std::floor(value);
    const auto end =
        whole ? std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<std::int64_t>(value))
              : std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end.ptr};
}

bool OptionRange::contains(double value) const {
    return std::isfinite(value) && (low_open ? value > low : value >= low) &&
           (high_open ? value < high : value <= high);
}

std::string OptionRange::text() const {
    const bool below = std::isfinite(high), above = std::isfinite(low);
    if (!above && !below) return "";
    if (above && below && !low_open && !high_open) return number_text(low) + " to " + number_text(high);
    const std::string from = (low_open ? "greater than " : "at least ") + number_text(low),
                      to = (high_open ? "less than " : "at most ") + number_text(high);
    return above && below ? from + ", " + to : above ? from : to;
}

std::string Option::flag() const {
    std::string flag = name;
    std::replace_if(
        flag.begin(), flag.end(), [](char c) { return c == '_' || c == '.'; }, '-');
    return flag;
}

std::string Option::unit() const {
    return std::string(range.unit.empty() ? unit_of(name) : range.unit);
}

std::string Option::allowed() const {
    if (choices.empty()) return range.text();
    std::string text;
    for (const std::string& choice : choices)
        text += (text.empty() ? "" : &choice == &choices.back() ? " or " : ", ") + choice;
    return text;
}

std::string Option::range_and_unit() const {
    const std::string text = range.text(), of = unit();
    return text.empty() || of.empty() ? text + of : text + " " + of;
}

void Option::set(const std::string& text) const {
    const auto require = [&](bool is_right, const char* what) {
        if (!is_right) throw std::invalid_argument(name + " is \"" + text + "\", must be " + what);
    };
    std::visit(
        [&](auto* field) {
            using T = std::decay_t<decltype(*field)>;
            if constexpr (std::is_same_v<T, std::string>) {
                *field = text;
            } else if constexpr (std::is_same_v<T, bool>) {
                require(text == "0" || text == "1", "0 or 1");
                *field = text == "1";
            } else {
                T value{};
                const char* end = text.data() + text.size();
                const auto [stop, error] = std::from_chars(text.data(), end, value);
                require(error == std::errc() && stop == end,
                        std::is_floating_point_v<T> ? "a number" : "a whole number");
                *field = value;
            }
        },
        field);
}

std::string Option::value() const {
    return std::visit(
        [](const auto* field) -> std::string {
            using T = std::decay_t<decltype(*field)>;
            if constexpr (std::is_same_v<T, std::string>) {
                return *field;
            } else if constexpr (std::is_same_v<T, bool>) {
                return *field ? "true" : "false";
            } else if constexpr (std::is_same_v<T, double>) {
                return number_text(*field);
            } else {
                return std::to_string(*field);
            }
        },
        field);
}

bool Option::is_allowed() const {
    return std::visit(
        [this](const auto* field) {
            using T = std::decay_t<decltype(*field)>;
            if constexpr (std::is_same_v<T, std::string>) {
                return choices.empty() || std::find(choices.begin(), choices.end(), *field) != choices.end();
            } else if constexpr (std::is_same_v<T, bool>) {
                return true;
            } else {
                return range.contains(static_cast<double>(*field));
            }
        },
        field);
}

void OptionList::add(std::string name, double& field, const OptionRange& range, std::string help,
                     Audience audience) {
    options_.push_back({std::move(name), &field, range, {}, std::move(help), audience});
}
void OptionList::add(std::string name, int& field, const OptionRange& range, std::string help,
                     Audience audience) {
    options_.push_back({std::move(name), &field, range, {}, std::move(help), audience});
}
void OptionList::add(std::string name, std::uint64_t& field, const OptionRange& range, std::string help,
                     Audience audience) {
    options_.push_back({std::move(name), &field, range, {}, std::move(help), audience});
}
void OptionList::add(std::string name, std::string& field, std::vector<std::string> choices, std::string help,
                     Audience audience) {
    options_.push_back({std::move(name), &field, {}, std::move(choices), std::move(help), audience});
}
void OptionList::add(std::string name, bool& field, std::string help, Audience audience) {
    options_.push_back({std::move(name), &field, {}, {}, std::move(help), audience});
}

void OptionList::append(const std::string& prefix, const OptionList& list) {
    for (Option option : list.options_) {
        option.name.insert(0, prefix);
        options_.push_back(std::move(option));
    }
}

void OptionList::check(FieldErrors& errors) const {
    for (const Option& option : options_) {
        const bool real = std::holds_alternative<double*>(option.field);
        const bool endless = !std::isfinite(option.range.low) || !std::isfinite(option.range.high);
        std::string allowed = option.allowed();
        if (real && endless) allowed.insert(0, allowed.empty() ? "finite" : "finite and ");
        errors.require(option.is_allowed(), option.name, option.value(), allowed);
    }
}

}  // namespace planemap
