// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "report/subject.hpp"

namespace planemap {

/// The figures that count of many reports, a row a report, as a Markdown table; "-" is not known.
std::string overview_markdown(const std::vector<Subject>& subjects);

}  // namespace planemap
