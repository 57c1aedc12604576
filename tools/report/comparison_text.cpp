// SPDX-License-Identifier: BSD-3-Clause
#include "report/comparison.hpp"
#include "run/report_text.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

std::string row(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + cell + " |";
    return text + "\n";
}

void add_figures(const Json& comparison, std::string& out) {
    out += "## Figures\n\n";
    if (comparison.at("figures").empty()) {
        out += "None differs.\n\n";
        return;
    }
    out += "| figure | A | B | change |\n| --- | ---: | ---: | ---: |\n";
    for (const Json& figure : comparison.at("figures"))
        out += row({figure.at("name").get<std::string>(), figure.at("a_text").get<std::string>(),
                    figure.at("b_text").get<std::string>(), figure.at("change_text").get<std::string>()});
    out += "\n" + comparison.at("figures_alike").dump() + " more are the same in both.\n\n";
}

void add_options(const Json& comparison, std::string& out) {
    if (comparison.at("options").empty()) return;
    out += "## Options that differ\n\n| flag | A | B |\n| --- | --- | --- |\n";
    const auto text = [](const Json& value) {
        return value.is_null() ? "-" : value.is_string() ? value.get<std::string>() : value.dump();
    };
    for (const Json& option : comparison.at("options"))
        out += row({"--" + option.at("flag").get<std::string>(), text(option.at("a")), text(option.at("b"))});
    out += "\n";
}

std::string area(const Json& plane) {
    return format("%.2f m²", plane.at("area").get<double>());
}

void add_plane_rows(const Json& planes, std::string& out) {
    out +=
        "| what | plane of A | plane of B | label | area in A | area in B | moved by | turned by |\n"
        "| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: |\n";
    for (const Json& plane : planes.at("appeared")) {
        const Json& on = plane.at("lies_on_a");
        out += row({on.is_null() ? "appeared" : "split off", on.is_null() ? "" : on.dump(),
                    plane.at("id").dump(), plane.at("label").get<std::string>(), "", area(plane), "", ""});
    }
    for (const Json& plane : planes.at("gone"))
        out += row({"gone", plane.at("id").dump(), "", plane.at("label").get<std::string>(), area(plane), "",
                    "", ""});
    for (const Json& pair : planes.at("moved"))
        out += row({"moved", pair.at("a").at("id").dump(), pair.at("b").at("id").dump(),
                    pair.at("b").at("label").get<std::string>(), area(pair.at("a")), area(pair.at("b")),
                    format("%+.3f m", pair.at("offset_m").get<double>()),
                    format("%.2f deg", pair.at("angle_deg").get<double>())});
}

void add_planes(const Json& comparison, std::string& out) {
    out += "## Planes\n\n";
    const Json &frames = comparison.at("world_frames"), &planes = comparison.at("planes");
    const std::string why = frames.at("why").get<std::string>();
    if (!frames.at("are_one").get<bool>()) {
        out += "The world frames differ, or are not known to be one: " + why +
               ". Planes cannot be compared, only figures.\n";
        return;
    }
    const auto count = [&](const char* key) { return std::to_string(planes.at(key).size()); };
    out += "One world frame: " + why + ". " + count("in_place") + " planes are in place (3 cm, 2 deg), " +
           count("moved") + " moved, " + count("appeared") + " appeared, " + count("gone") + " are gone.\n";
    if (planes.at("moved").empty() && planes.at("appeared").empty() && planes.at("gone").empty()) return;
    out += "\n";
    add_plane_rows(planes, out);
}

}  // namespace

std::string comparison_markdown(const Json& comparison) {
    std::string out = "# planemap: two maps\n\nA is " + comparison.at("a").get<std::string>() + ", B is " +
                      comparison.at("b").get<std::string>() + ".\n\n";
    add_figures(comparison, out);
    add_options(comparison, out);
    add_planes(comparison, out);
    return out;
}

}  // namespace planemap
