// SPDX-License-Identifier: BSD-3-Clause
#include "options/options_document.hpp"

#include <algorithm>

#include "camera/options.hpp"
#include "export/cloud_options.hpp"
#include "graph/graph.hpp"
#include "map/map.hpp"
#include "messages/process.hpp"
#include "octomap/octomap_builder.hpp"
#include "odometry/options.hpp"
#include "run/run_options.hpp"
#include "segmentation/segmentation.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"
#include "viewer/viewer_shell.hpp"

namespace planemap {

namespace {

constexpr const char* kIntroduction = R"(# Options

Written by `ninja options_document` from the lists that the flags and their checks come from (`options_of()` of each
module): a test compares this page with them.

Unless something else is said, these are flags of `planemap-run`. A module's own process takes its flags without the leading word: `--map-merge-gap-m` of
`planemap-run` is `--merge-gap-m` of `planemap-map`. Any of them may stand in a file for `--config`, without the dashes:
`map-merge-gap-m = 0.3`. `--help` shows the first table of each module, `--help-all` both.
)";

std::string in_code(const std::string& text) {
    return text.empty() ? "" : "`" + text + "`";
}

std::string row(const Option& option, const std::string& name) {
    const std::string value = option.value();
    const std::string allowed = option.choices.empty() ? option.range.text() : option.allowed();
    return "| " + in_code(name) + " | " + in_code(value) + " | " + allowed + " | " + option.unit() + " | " +
           option.help + " |\n";
}

std::string rows(const OptionList& list, const std::string& lead, Audience audience) {
    std::string text;
    for (const Option& option : list.options()) {
        if (option.audience == audience)
            text += row(option, lead + (lead.empty() ? option.name : option.flag()));
    }
    return text;
}

/// `lead` stands before each flag's name; without it, the names are keys and not flags.
std::string section(const OptionList& list, const std::string& lead, const std::string& introduction) {
    const std::string head = "| name | default | allowed | unit | what |\n| --- | --- | --- | --- | --- |\n";
    const std::string common = rows(list, lead, Audience::kUser),
                      seldom = rows(list, lead, Audience::kExpert);
    std::string text = "\n## " + list.heading() + "\n";
    if (!introduction.empty()) text += introduction + "\n";
    if (!common.empty()) text += "\n" + head + common;
    if (!seldom.empty()) text += "\nSeldom set:\n\n" + head + seldom;
    return text;
}

/// A line end would end a row of a table.
std::string in_cell(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// The flags that a program adds for itself.
std::string section(const std::string& heading, const std::string& introduction,
                    const messages::Flags& flags) {
    std::string text =
        "\n## " + heading + "\n" + introduction + "\n\n| name | default | what |\n| --- | --- | --- |\n";
    for (const messages::OwnFlag& flag : flags.own()) {
        const bool is_argument = flag.name == "input";
        text += "| " + in_code((is_argument ? "" : "--") + flag.name) + " | " + in_code(flag.value) + " | " +
                in_cell(flag.help) + " |\n";
    }
    return text;
}

/// A module's options with their defaults.
template <typename Options>
std::string section(const std::string& lead) {
    Options defaults;
    return section(options_of(defaults), lead, "");
}

}  // namespace

std::string options_document() {
    sensor::SensorShellOptions sensor;
    simulator::SimulatorOptions simulator;
    camera::CameraOptions camera;
    odometry::MotionPriorOptions motion;
    CloudOptions cloud;
    viewer::ViewerOptions viewer;
    RunOptions run;
    messages::Flags run_flags("planemap-run", "");
    add_run_flags(run_flags, run);
    messages::Process process("MODULE", "");
    return kIntroduction + section("planemap-run", "Its own, beside those of the modules below.", run_flags) +
           section(thread_options(run), "--", "") + section(report_options(run), "--", "") +
           section("Every module's process",
                   "Of `planemap-sensor`, `-segmentation`, `-odometry`, `-graph`, `-map`, `-octomap` and "
                   "`-viewer`. What a\nprogram has besides, its `--help` tells.",
                   process.flags()) +
           section<segmentation::SegmentationOptions>("--segmentation-") +
           section<odometry::OdometryOptions>("--odometry-") +
           section(options_of(motion), "--",
                   "Of `planemap-run` (from a log) and `planemap-odometry` "
                   "([odometry.md](odometry.md#motion-priors)).") +
           section<graph::GraphOptions>("--graph-") + section<map::MapOptions>("--map-") +
           section<octomap::OctomapOptions>("--octomap-") +
           section(sensor::pacing_of(sensor), "--", "Of `planemap-sensor`.") +
           section(sensor::encoding_of(sensor), "--", "Of `planemap-sensor` and `planemap-simulate`.") +
           section(options_of(viewer), "--", "Of `planemap-viewer`.") +
           section(options_of(camera), "--camera-",
                   "Of `planemap-sensor` and `planemap-run` on a live camera ([live.md](live.md)).") +
           section(options_of(cloud), "--cloud-",
                   "Of `planemap-export` with `--cloud` "
                   "([formats.md](formats.md#what-planemap-export-adds)).") +
           section(options_of(simulator), "",
                   "Parameters of a name, as in `sim:office?frames=300&seed=7`; `planemap-simulate --help` "
                   "lists the worlds.");
}

}  // namespace planemap
