// SPDX-License-Identifier: BSD-3-Clause
#include "report/overview.hpp"

#include "report/figures.hpp"

namespace planemap {

std::string overview_markdown(const std::vector<Subject>& subjects) {
    std::string head = "| map |", line = "| --- |", rows;
    for (const Figure& figure : figures_of({})) {
        if (!figure.in_overview) continue;
        head += " " + figure.name + " |";
        line += " ---: |";
    }
    for (const Subject& subject : subjects) {
        rows += "| " + subject.path.string() + " |";
        for (const Figure& figure : figures_of({}))
            if (figure.in_overview)
                rows += " " + figure_text(value_of(subject.report, figure), figure.kind) + " |";
        rows += "\n";
    }
    return "# planemap: " + std::to_string(subjects.size()) + " maps\n\n" + head + "\n" + line + "\n" + rows;
}

}  // namespace planemap
