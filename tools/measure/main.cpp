// SPDX-License-Identifier: BSD-3-Clause
// planemap-measure: distances and angles between the planes of a map, with their certainty.
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files.hpp"
#include "core/standard_output.hpp"
#include "core/text_file.hpp"
#include "measure/map_input.hpp"
#include "measure/measures.hpp"
#include "messages/process.hpp"

namespace planemap {
namespace {

struct Arguments {
    std::vector<std::string> map_and_ids;
    std::string json_file, csv_file;
    bool all = false;
};

int id_of(const std::string& text) {
    int id = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size() || id < 0)
        throw std::invalid_argument("\"" + shown_text(text) +
                                    "\" is no id of a plane: a whole number from 0");
    return id;
}

std::vector<Measure> measured(const Arguments& arguments, const PlaneMap& map) {
    std::vector<int> ids;
    for (std::size_t i = 1; i < arguments.map_and_ids.size(); ++i)
        ids.push_back(id_of(arguments.map_and_ids[i]));
    if (arguments.all && !ids.empty()) throw std::invalid_argument("--all is every pair: it takes no ids");
    if (arguments.all) return measures_of_all(map);
    return ids.empty() ? measures_of_rooms(map) : measures_of(map, ids);
}

void put(const std::string& file, const std::string& text) {
    if (file == "-") {
        print(text);
    } else if (!file.empty()) {
        write_file(file, text);
    }
}

int run(const Arguments& arguments) {
    if (arguments.json_file == "-" && arguments.csv_file == "-")
        throw std::invalid_argument("--json and --csv: only one of them can go to standard output");
    const PlaneMap map = read_map(arguments.map_and_ids[0]);
    const std::vector<Measure> measures = measured(arguments, map);
    if (!arguments.json_file.empty()) put(arguments.json_file, measures_json(map, measures).dump(1) + "\n");
    if (!arguments.csv_file.empty()) put(arguments.csv_file, measures_csv(map, measures));
    if (arguments.json_file != "-" && arguments.csv_file != "-")
        print(measures_text(map, measures, arguments.map_and_ids.size() == 1));
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::messages::Flags flags("planemap-measure",
                                    "Measures a map: areas of its planes, floor to ceiling, wall to wall and "
                                    "how thick walls are; with ids of "
                                    "planes, the\n"
                                    "angle and distance of every pair of them. Each with its standard "
                                    "deviation, as far as the map tells it.\n"
                                    "Example: planemap-measure out 2 6 --json measures.json");
    planemap::Arguments arguments;
    flags.add("json", arguments.json_file,
              "Write the measures as JSON to this file, or to - (standard output)");
    flags.add("csv", arguments.csv_file, "The same as CSV");
    flags.add("all", arguments.all, "Every pair of planes");
    flags.add_positionals(
        "MAP [ID ID ...]", arguments.map_and_ids,
        "plane_map.lcmlog (or a log with PLANEMAP_MAP), planes.json, or a folder of results; then "
        "ids of planes, as planes.json and overhead.svg have them");
    return planemap::messages::run_program(flags, argc, argv, [&] { return planemap::run(arguments); });
}
