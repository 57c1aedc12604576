// SPDX-License-Identifier: BSD-3-Clause
#include "results/table.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace planemap::results {

namespace {

std::string shown(const Column& column, const Json& row) {
    if (column.key == nullptr) return column.heading;
    const Json& value = row.at(column.key);
    if (value.is_string()) return text("%*s", column.width, value.get<std::string>().c_str());
    const double number = figure(row, column.key);
    return cell(column.shown != nullptr ? column.shown(number) : number, column.width, column.decimals);
}

}  // namespace

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string cell(double value, int width, int decimals) {
    return std::isfinite(value) ? text("%*.*f", width, decimals, value) : text("%*s", width, "-");
}

double figure(const Json& row, const char* key) {
    const Json& value = row.at(key);
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::string Table::heading() const {
    std::string line;
    for (const Column& column : columns_)
        line += (line.empty() ? "" : " ") + text("%*s", column.width, column.heading);
    return line + "\n";
}

std::string Table::line(const Json& row) const {
    std::string line;
    for (const Column& column : columns_) line += (line.empty() ? "" : " ") + shown(column, row);
    return line + "\n";
}

}  // namespace planemap::results
