// SPDX-License-Identifier: BSD-3-Clause
// Rows of figures: what is measured is JSON, as --json writes it, and a table shows parts of it as text.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace planemap::results {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: null for what is not known.
Json number(double value);

/// The figure of something that may be missing; null without it.
template <typename From, typename Figure>
Json known(const std::optional<From>& from, const Figure& figure) {
    return from ? Json(figure(*from)) : Json(nullptr);
}

/// As printf(), for lines of at most 255 characters.
template <typename... Values>
std::string text(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof(line), format, values...);
    return line;
}

/// A number right-aligned in `width` characters; "-" if it is not known.
std::string cell(double value, int width, int decimals);

/// A row's number; NaN for null.
double figure(const Json& row, const char* key);

/// One column: the heading, and under it a row's value.
struct Column {
    const char* heading;
    const char* key = nullptr;          ///< in the row; nothing: the heading stands in every line, e.g. "|"
    int width = 0;                      ///< characters; as printf() has it, negative: left-aligned
    int decimals = 0;                   ///< of a number
    double (*shown)(double) = nullptr;  ///< in another unit than the row's
};

inline constexpr Column kBar{"|"};
/// Units for people.
inline double milli(double value) {
    return 1e3 * value;
}
inline double percent(double value) {
    return 100 * value;
}

/// Rows as lines with aligned columns, a space between two; "-" for what is null. Lines end with a newline.
class Table {
  public:
    Table(std::initializer_list<Column> columns) : columns_(columns) {}
    std::string heading() const;
    std::string line(const Json& row) const;

  private:
    std::vector<Column> columns_;
};

}  // namespace planemap::results
