// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files.hpp"
#include "core/json_file.hpp"
#include "evaluate/soundness_report.hpp"
#include "run/growth.hpp"
#include "run/leaf_accuracy.hpp"
#include "run/losses.hpp"
#include "run/report_text.hpp"
#include "run/size_report.hpp"
#include "run/stages.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

/// Of a map that planemap-export found in a file: nothing is known of the run that made it.
bool is_exported(const Json& report) {
    return report.value("exported", false);
}

std::string number(const Json& report, const char* key) {
    return format("%.0f", report.at(key).get<double>());
}

void add_origin(const Json& report, std::string& out) {
    if (!report.contains("version")) return;
    const Json seed = report.value("seed", Json());
    out += "planemap " + report.at("version").get<std::string>() + ", " +
           report.at("date").get<std::string>() + (seed.is_number() ? ", seed " + seed.dump() : "") +
           "; all options are in report.json.\n\n";
}

void add_tracking(const Json& report, std::string& out) {
    const auto count = [&](const char* key) { return number(report, key); };
    out += count("frames") + " frames: " + count("tracked") + " tracked, " + count("lost") + " lost, " +
           count("broken") + " broken. " + count("keyframes") + " keyframes, " + count("loop_closures") +
           " loop closures, " + count("planes") + " planes.\n\n";
    if (report.contains("components") && report["components"].size() > 1) {
        const Json& components = report["components"];
        out +=
            std::to_string(components.size()) +
            " components do not hang together: tracking was lost, or time or the sensor started again, and "
            "no loop closure tied them. Where one lies in another is not known. What follows, and the "
            "pictures, are of the largest.\n\n| component | keyframes | frames | planes | from s | to s "
            "| trajectory |\n| --- | --- | --- | --- | --- | --- | --- |\n";
        for (const Json& component : components) {
            for (const char* key : {"component", "keyframes", "frames", "planes", "from_s", "to_s"})
                out += "| " + (component.at(key).is_null() ? "-" : component.at(key).dump()) + " ";
            const Json& file = component.at("trajectory");
            out += "| " + (file.is_null() ? "-" : file.get<std::string>()) + " |\n";
        }
        out += "\n";
    }
    if (report.value("degenerate", 0) > 0)
        out += "In " + count("degenerate") + " frames a direction is known by the prediction alone.\n\n";
    if (report.value("stale", 0) > 0) {
        out += "In " + count("stale") +
               " frames nothing new said where the camera was: they have the pose before them, or none where "
               "the camera may have "
               "gone far.\n\n";
    }
    if (report.contains("up")) {
        const Json& up = report.at("up");
        const std::string why = up.at("why").get<std::string>();
        out += up.at("direction").is_null() ? "Up is not known: " + why + ".\n\n"
                                            : "Up is known " + why + ".\n\n";
    }
    if (report.value("interrupted", false)) out += "The run ended before the end of its input.\n\n";
}

void add_what_is_known(const Json& report, std::string& out) {
    out += number(report, "planes") + " planes, " +
           (report.at("tracked").is_number() ? number(report, "tracked") + " poses" : "no trajectory") +
           ". Made of a stored map: its input, frames, keyframes, loop closures, losses and times are not "
           "known.\n\n";
}

void add_accuracy(const Json& report, std::string& out) {
    if (report.contains("accuracy")) {
        const Json& accuracy = report.at("accuracy");
        out += "Against the truth beside the input: ATE " +
               format("%.4f m", accuracy.at("ate_rmse_m").get<double>()) + ", RPE per frame ";
        if (accuracy.at("rpe_frame_rmse_m").is_number()) {
            out += format("%.2f mm", 1000 * accuracy.at("rpe_frame_rmse_m").get<double>()) + " and " +
                   format("%.3f deg", accuracy.at("rpe_frame_rmse_deg").get<double>()) + " (RMSE)";
        } else {
            out += accuracy.value("rpe_frame_why", "not measured");
        }
        out += ".\n";
    }
    if (report.contains("accuracy_note"))
        out += "Accuracy: " + report.at("accuracy_note").get<std::string>() + ".\n";
    if (report.contains("accuracy") || report.contains("accuracy_note")) out += "\n";
}

void add_remarks(const Json& report, std::string& out) {
    for (const Json& warning : report.value("warnings", Json::array()))
        out += "**Warning:** " + warning.get<std::string>() + ".\n\n";
    if (report.contains("complaints") && !report.at("complaints").empty()) {
        out += "What was wrong with the input:\n\n";
        for (const Json& line : report.at("complaints")) out += "- " + line.get<std::string>() + "\n";
        out += "\n";
    }
}

/// A field that a report has, by its JSON pointer.
struct Field {
    const char *pointer, *type;
};

constexpr Field kFields[] = {{"/input", "string"},       {"/planes", "number"},
                             {"/sizes_bytes", "object"}, {"/sizes_bytes/plane_map_message", "number"},
                             {"/octomap", "object"},     {"/coverage", "object"}};
constexpr Field kFieldsOfARun[] = {
    {"/frames", "number"},      {"/tracked", "number"},       {"/lost", "number"},   {"/broken", "number"},
    {"/keyframes", "number"},   {"/loop_closures", "number"}, {"/wall_s", "number"}, {"/cpu_s", "number"},
    {"/peak_rss_mb", "number"}, {"/stages_ms", "object"}};

/// Throws std::runtime_error naming the first field that is missing or of another type.
void check_fields(const Json& report) {
    const auto fail = [](const std::string& why) {
        throw std::runtime_error("is no report of planemap-run: " + why);
    };
    if (!report.is_object()) fail(std::string("is ") + report.type_name() + ", not object");
    const auto check = [&](const Field& field) {
        const Json::json_pointer at(field.pointer);
        const std::string name = std::string(field.pointer).substr(1);
        if (!report.contains(at)) fail(name + " is missing");
        const std::string type = report.at(at).type_name();
        if (type != field.type) fail(name + " is " + type + ", not " + field.type);
    };
    for (const Field& field : kFields) check(field);
    if (!is_exported(report))
        for (const Field& field : kFieldsOfARun) check(field);
}

/// Why there is no report.json, as far as the folder tells, and what to do.
std::string why_no_report(const std::filesystem::path& folder) {
    std::error_code ignored;
    const auto holds = [&](const char* name) { return std::filesystem::exists(folder / name, ignored); };
    if (!std::filesystem::exists(folder, ignored)) return "there is no such folder";
    if (holds(".partial-whole"))
        return "a run was ended while it put its results in place; they are whole, in " +
               (folder / ".partial-whole").string() +
               ", and the next planemap-run into this folder ends that first";
    if (holds(".partial"))
        return "a run into this folder goes on or did not end, and the report comes at the end; what it had "
               "so far is "
               "in " +
               (folder / ".partial").string() + ", and the next planemap-run into this folder keeps that";
    return "is not there: this is no output folder of a planemap-run that ended";
}

}  // namespace

Json read_report(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "report.json";
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw std::runtime_error(file.string() + ": " + why_no_report(folder));
    read_json_object(file);  // says where it is wrong, but keeps no order
    return Json::parse(read_file(file));
}

std::string report_markdown(const Json& report) {
    check_fields(report);
    try {
        std::string out = "# planemap: " + report.at("input").get<std::string>() + "\n\n";
        add_origin(report, out);
        is_exported(report) ? add_what_is_known(report, out) : add_tracking(report, out);
        add_accuracy(report, out);
        add_remarks(report, out);
        out += losses_markdown(report);
        out += sizes_markdown(report);
        out += evaluation::coverage_markdown(report.at("coverage"));
        out += leaf_accuracy_markdown(report);
        if (report.contains("soundness")) out += evaluation::soundness_markdown(report);
        out += growth_markdown(report);
        if (!is_exported(report)) out += stages_markdown(report);
        return out;
    } catch (const Json::exception& error) {
        throw std::runtime_error(std::string("is no report of planemap-run: ") + error.what());
    }
}

}  // namespace planemap
