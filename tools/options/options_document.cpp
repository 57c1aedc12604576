// SPDX-License-Identifier: BSD-3-Clause
#include "options/options_document.hpp"

#include "camera/options.hpp"
#include "export/cloud_options.hpp"
#include "graph/graph.hpp"
#include "map/map.hpp"
#include "octomap/octomap_builder.hpp"
#include "odometry/options.hpp"
#include "segmentation/segmentation.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap {

namespace {

constexpr const char* kIntroduction = R"(# Options

Written by `ninja options_document` from the lists that the flags and their checks come from (`options_of()` of each
module): a test compares this page with them.

These are flags of `planemap-run`. A module's own process takes its flags without the leading word: `--map-merge-gap-m` of
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
    text += "\n" + head + common;
    if (!seldom.empty()) text += "\nSeldom set:\n\n" + head + seldom;
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
    return kIntroduction + section<segmentation::SegmentationOptions>("--segmentation-") +
           section<odometry::OdometryOptions>("--odometry-") +
           section(options_of(motion), "--",
                   "Of `planemap-run` (from a log) and `planemap-odometry` "
                   "([odometry.md](odometry.md#motion-priors)).") +
           section<graph::GraphOptions>("--graph-") + section<map::MapOptions>("--map-") +
           section<octomap::OctomapOptions>("--octomap-") +
           section(sensor::pacing_of(sensor), "--", "Of `planemap-sensor`.") +
           section(sensor::encoding_of(sensor), "--", "Of `planemap-sensor` and `planemap-simulate`.") +
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
