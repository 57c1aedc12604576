// SPDX-License-Identifier: BSD-3-Clause
// The figures of a report that say how one map stands beside another.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace planemap {

enum class FigureKind {
    kCount,
    kBytes,
    kTimes,
    kShare,
    kMetres,
    kMillimetres,
    kDegrees,
    kSeconds,
    kMilliseconds,
    kMegabytes
};

/// A figure of report.json: where it stands (JSON pointer), and what it is called.
struct Figure {
    std::string pointer, name;
    FigureKind kind = FigureKind::kCount;
    bool in_overview = false;  ///< also in the table of many reports
};

/// All of them, in the order that a reader wants them; those of stages are of the stages that a report names.
std::vector<Figure> figures_of(const nlohmann::ordered_json& report);

/// Nothing where the report does not tell, or tells something else than a number.
std::optional<double> value_of(const nlohmann::ordered_json& report, const Figure& figure);

/// "7.5 kB", "86.6 %"; "-" for nothing.
std::string figure_text(const std::optional<double>& value, FigureKind kind);

/// From a to b: "+12.5 %", of shares "+1.2 points"; empty where either is not known, or a is zero.
std::string change_text(const std::optional<double>& a, const std::optional<double>& b, FigureKind kind);

}  // namespace planemap
