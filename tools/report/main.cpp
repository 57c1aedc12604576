// SPDX-License-Identifier: BSD-3-Clause
// planemap-report: prints the size report of a finished run.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "core/standard_output.hpp"
#include "messages/process.hpp"
#include "run/report.hpp"

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-report",
        "Prints the report of a run: what the plane map takes beside an OctoMap, clouds "
        "and voxels of the same run, and at\n"
        "what coverage. Reads report.json of planemap-run's output folder and writes "
        "report.md beside it anew.");
    std::string folder_name;
    flags.add_positional("folder", folder_name, "Output folder of planemap-run");
    return planemap::messages::run_program(flags, argc, argv, [&] {
        const std::filesystem::path folder = folder_name;
        const nlohmann::ordered_json report = planemap::read_report(folder);
        std::string markdown;
        try {
            markdown = planemap::report_markdown(report);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error((folder / "report.json").string() + ": " + error.what());
        }
        planemap::print(markdown);
        planemap::write_file(folder / "report.md", markdown);
        return 0;
    });
}
