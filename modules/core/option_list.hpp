// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/validation.hpp"

namespace planemap {

/// What a number may be, both ends included unless they are open. What is not finite is never allowed.
struct OptionRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::string_view unit = {};  ///< empty: as the name's suffix says, see unit_of()
    bool low_open = false, high_open = false;

    bool contains(double value) const;
    /// "0 to 45", "at least 3", "greater than 0, at most 1"; empty where all is allowed.
    std::string text() const;
};
constexpr OptionRange kAnyNumber{};
constexpr OptionRange kShare{0, 1};
constexpr OptionRange at_least(double low, std::string_view unit = {}) {
    return {.low = low, .unit = unit};
}
constexpr OptionRange greater_than(double low, std::string_view unit = {}) {
    return {.low = low, .unit = unit, .low_open = true};
}
/// Both ends excluded.
constexpr OptionRange between(double low, double high) {
    return {.low = low, .high = high, .low_open = true, .high_open = true};
}

/// Whom an option is for: `--help` shows users theirs, `--help-all` shows all.
enum class Audience { kUser, kExpert };

/// All that is said of an option, once: the flag, its help, the check and the table of docs/options.md come
/// from here. The default is what the field holds in new options.
struct Option {
    using Field = std::variant<bool*, int*, double*, std::uint64_t*, std::string*>;

    std::string name;  ///< the field's, "cells.thickness_m"
    Field field;
    OptionRange range;                 ///< of a number
    std::vector<std::string> choices;  ///< what a text may be; none: anything
    std::string help;                  ///< complete in itself
    Audience audience = Audience::kUser;

    /// The name as a flag's: "cells-thickness-m".
    std::string flag() const;
    /// Of a number: the range's unit, or what the name ends in (_m, _deg, _px, ...); empty for none.
    std::string unit() const;
    /// "0 to 45", "cells or ransac"; empty where all is allowed.
    std::string allowed() const;
    /// "0 to 100 m"; empty where all is allowed and there is no unit.
    std::string range_and_unit() const;
    /// Sets the field. Throws std::invalid_argument, "NAME is "x", must be a number", for a text that is no
    /// value of its type (a flag's are 0 and 1); the range is not checked.
    void set(const std::string& text) const;
    /// The field's value now, numbers with the fewest digits that give the same number again.
    std::string value() const;
    bool is_allowed() const;
};

/// The options of one module, in the order in which they are told. Refers to the fields of the struct that
/// it is made from, which must outlive it.
///   OptionList options_of(MapOptions& options) {
///       OptionList list("Map");
///       list.add("merge_gap_m", options.merge_gap_m, {0, 100}, "largest gap between merged regions");
class OptionList {
  public:
    /// The heading in --help and in docs/options.md.
    explicit OptionList(std::string heading) : heading_(std::move(heading)) {}

    void add(std::string name, double& field, const OptionRange& range, std::string help,
             Audience audience = Audience::kUser);
    void add(std::string name, int& field, const OptionRange& range, std::string help,
             Audience audience = Audience::kUser);
    void add(std::string name, std::uint64_t& field, const OptionRange& range, std::string help,
             Audience audience = Audience::kUser);
    /// One of the choices; without any, a text of any kind.
    void add(std::string name, std::string& field, std::vector<std::string> choices, std::string help,
             Audience audience = Audience::kUser);
    void add(std::string name, bool& field, std::string help, Audience audience = Audience::kUser);
    /// Another list's options, their names led by `prefix`.
    void append(const std::string& prefix, const OptionList& list);

    const std::string& heading() const { return heading_; }
    const std::vector<Option>& options() const& { return options_; }
    void options() && = delete;  ///< a list that is gone when its options are read
    /// Adds each field whose value is not allowed.
    void check(FieldErrors& errors) const;

  private:
    std::string heading_;
    std::vector<Option> options_;
};

/// Throws std::invalid_argument that names every field of `options` whose value options_of() does not allow,
/// and begins with `what`.
template <typename Options>
void check_options(std::string_view what, Options options) {
    FieldErrors errors(what);
    options_of(options).check(errors);
    errors.throw_if_any();
}

/// What a name's suffix says of its unit: "m" for "gap_m", "1/m" for "quadratic_per_m"; empty for none.
std::string_view unit_of(std::string_view name);

/// A number with the fewest digits that give the same number again; a whole one without an exponent.
std::string number_text(double value);

}  // namespace planemap
