// SPDX-License-Identifier: BSD-3-Clause
// planemap-report: what maps take, at what coverage, and what differs between two of them.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files.hpp"
#include "core/standard_output.hpp"
#include "messages/process.hpp"
#include "report/comparison.hpp"
#include "report/overview.hpp"
#include "run/report.hpp"

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;

struct ReportOptions {
    std::vector<std::string> inputs;
    bool compare = false, json = false, markdown = false, html = false;
};

/// One line that names what goes wrong with a report, with its file.
std::string markdown_of(const Subject& subject) {
    try {
        return report_markdown(subject.report);
    } catch (const std::runtime_error& error) {
        const std::filesystem::path file = subject.is_folder ? subject.path / "report.json" : subject.path;
        throw std::runtime_error(file.string() + ": " + error.what());
    }
}

/// JSON for programs: whatever bytes are in it.
std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json reports_of(const std::vector<Subject>& subjects) {
    if (subjects.size() == 1) return subjects.front().report;
    Json all = Json::array();
    for (const Subject& subject : subjects)
        all.push_back({{"path", subject.path.string()}, {"report", subject.report}});
    return all;
}

void check(const ReportOptions& options) {
    if (options.compare && options.inputs.size() != 2)
        throw std::invalid_argument("--compare takes two folders or logs, not " +
                                    std::to_string(options.inputs.size()));
    if (options.compare && options.html)
        throw std::invalid_argument("--compare gives text or --json, not --html");
    if (options.json && options.markdown)
        throw std::invalid_argument("--json and --md are two forms of standard output: give one of them");
}

int report(const ReportOptions& options) {
    check(options);
    std::vector<Subject> subjects;
    for (const std::string& input : options.inputs) subjects.push_back(read_subject(input));
    if (options.compare) {
        const Json comparison = compare(subjects[0], subjects[1]);
        print(options.json ? text_of(comparison) : comparison_markdown(comparison));
        return 0;
    }
    std::vector<std::string> markdown;  // also checks that they are reports
    for (const Subject& subject : subjects) markdown.push_back(markdown_of(subject));
    std::string pages;
    if (options.html) {
        for (const Subject& subject : subjects) {
            write_file(subject.page_file(), report_page(subject.page_source()));
            pages += subject.page_file().string() + "\n";
        }
    }
    if (options.json) {
        print(text_of(reports_of(subjects)));
    } else if (options.html && !options.markdown) {
        print(pages);
    } else {
        for (std::size_t i = 0; i < subjects.size(); ++i)
            if (subjects[i].is_folder) write_file(subjects[i].path / "report.md", markdown[i]);
        print(subjects.size() == 1 ? markdown.front() : overview_markdown(subjects));
    }
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-report",
        "Prints the report of a run: what the plane map takes beside an OctoMap, clouds and voxels of the "
        "same "
        "run, and at\n"
        "what coverage. Reads report.json of planemap-run's output folder and writes report.md beside it "
        "anew. "
        "Of several\n"
        "folders a table of what counts; of a log with a map in it, what the map alone tells.\n"
        "Examples: planemap-report out/office\n"
        "          planemap-report out/office --html\n"
        "          planemap-report --compare out/before out/after");
    planemap::ReportOptions options;
    flags.add_positionals("inputs", options.inputs,
                          "Output folders of planemap-run or planemap-export, or LCM logs with a map "
                          "(plane_map.lcmlog, a session's log)");
    flags.add(
        "compare", options.compare,
        "What differs between two: figures, options, and, in one world frame, which planes appeared, went or "
        "moved");
    flags.add("json", options.json, "JSON on standard output, instead of text");
    flags.add("md", options.markdown,
              "Markdown on standard output, which is the default, beside --html, too");
    flags.add("html", options.html,
              "Writes report.html into the folder, of a log beside it under its name, and prints its path");
    return planemap::messages::run_program(flags, argc, argv, [&] { return planemap::report(options); });
}
