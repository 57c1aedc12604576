// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/angle.hpp"
#include "core/geometry/plane_intersection.hpp"
#include "exports/parts.hpp"
#include "measure/measures.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;
using exports::fixed;

const char* sides_name(map::Sides sides) {
    switch (sides) {
        case map::Sides::kFacing:
            return "facing";
        case map::Sides::kBackToBack:
            return "back to back";
        case map::Sides::kSameWay:
            break;
    }
    return "same way";
}

/// Why two planes have no distance; empty if they have one.
std::string why_no_distance(const map::PlaneRelation& relation) {
    if (relation.distance) return {};
    if (!std::isfinite(relation.angle)) return "a plane is not finite";
    const double off = degrees(std::min(relation.angle, std::numbers::pi - relation.angle));
    return fixed(off, 1) + " deg from parallel";
}

std::optional<double> offset_sigma(const MapPlane& plane) {
    const auto certainty = map::certainty_of(plane);
    return certainty ? std::optional(certainty->offset) : std::nullopt;
}

/// Text at the end, or the start, of a column.
std::string right(const std::string& text, std::size_t width) {
    return text.size() >= width ? text : std::string(width - text.size(), ' ') + text;
}
std::string left(const std::string& text, std::size_t width) {
    return text.size() >= width ? text : text + std::string(width - text.size(), ' ');
}

std::string number_or_unknown(double value, int decimals) {
    return std::isfinite(value) ? fixed(value, decimals) : "unknown";
}

/// "3.421 +- 0.012"; "+- ?" where that is not known.
std::string with_sigma(double value, const std::optional<double>& sigma, int decimals) {
    return fixed(value, decimals) + " +- " + (sigma ? fixed(*sigma, decimals) : "unknown");
}

std::string planes_text(const PlaneMap& map) {
    std::string text = "plane  label        seen m2  inferred m2   rms mm  keyframes  offset sigma mm\n";
    for (const MapPlane& plane : map.planes) {
        const auto sigma = offset_sigma(plane);
        text += right(std::to_string(plane.id), 5) + "  " + left(label_name(plane.label), 11) +
                right(number_or_unknown(plane.area, 2), 9) +
                right(number_or_unknown(exports::inferred_area(map, plane.id), 2), 13) +
                right(number_or_unknown(1e3 * static_cast<double>(plane.rms), 1), 9) +
                right(plane.keyframes > 0 ? std::to_string(plane.keyframes) : "unknown", 11) +
                right(sigma ? fixed(1e3 * *sigma, 1) : "unknown", 17) + "\n";
    }
    return text;
}

std::string measure_text(const PlaneMap& map, const Measure& measure) {
    const map::PlaneRelation& relation = measure.relation;
    const auto named = [&](int id) { return std::to_string(id) + " " + label_name(map.find(id)->label); };
    std::string text = left(measure.kind, 17) + left(named(measure.a), 15) + left(named(measure.b), 15);
    const auto in_degrees = [](const std::optional<double>& radians) {
        return radians ? std::optional(degrees(*radians)) : std::nullopt;
    };
    text += left(std::isfinite(relation.angle)
                     ? with_sigma(degrees(relation.angle), in_degrees(relation.angle_sigma), 2)
                     : "unknown",
                 19);
    if (relation.distance) {
        text +=
            left(with_sigma(*relation.distance, relation.distance_sigma, 3), 19) + sides_name(relation.sides);
        text += relation.opposite > 0
                    ? ", " + fixed(relation.least, 3) + " to " + fixed(relation.most, 3) + " m over the " +
                          fixed(relation.opposite, 2) + " m2 that lie opposite"
                    : ", beside each other: between their middles";
    } else {
        text += "none: " + why_no_distance(relation);
    }
    if (measure.gap) text += "; outlines " + fixed(*measure.gap, 3) + " m apart";
    return text + "\n";
}

Json rounded(const std::optional<double>& value) {
    constexpr double kPerUnit = 1e6;
    if (!value || !std::isfinite(*value)) return nullptr;
    return std::round(kPerUnit * *value) / kPerUnit + 0.0;  // no negative zero
}

Json rounded_degrees(const std::optional<double>& value) {
    return value ? rounded(degrees(*value)) : Json();
}

Json position(const Eigen::Vector3d& p) {
    return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json plane_json(const PlaneMap& map, const MapPlane& plane) {
    return {{"id", plane.id},
            {"label", label_name(plane.label)},
            {"area_m2", rounded(plane.area)},
            {"inferred_area_m2", rounded(exports::inferred_area(map, plane.id))},
            {"rms_m", rounded(plane.rms)},
            {"keyframes", plane.keyframes > 0 ? Json(plane.keyframes) : Json()},
            {"offset_sigma_m", rounded(offset_sigma(plane))}};
}

Json measure_json(const PlaneMap& map, const Measure& measure) {
    const map::PlaneRelation& relation = measure.relation;
    Json json = {{"kind", measure.kind},
                 {"planes", {measure.a, measure.b}},
                 {"labels", {label_name(map.find(measure.a)->label), label_name(map.find(measure.b)->label)}},
                 {"angle_deg", rounded_degrees(relation.angle)},
                 {"angle_sigma_deg", rounded_degrees(relation.angle_sigma)},
                 {"distance_m", rounded(relation.distance)},
                 {"distance_sigma_m", rounded(relation.distance_sigma)}};
    if (relation.distance) {
        json["least_m"] = rounded(relation.least);
        json["most_m"] = rounded(relation.most);
        json["opposite_m2"] = rounded(relation.opposite);
        json["sides"] = sides_name(relation.sides);
        json["from"] = position(relation.on_a);
        json["to"] = position(relation.on_b);
    } else {
        json["why_no_distance"] = why_no_distance(relation);
    }
    if (measure.gap) json["gap_m"] = rounded(measure.gap);
    return json;
}

/// A cell of a table: numbers as JSON has them, nothing for what is not known.
std::string cell(const Json& value) {
    if (value.is_null()) return {};
    return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::string measures_text(const PlaneMap& map, const std::vector<Measure>& measures, bool with_planes) {
    std::string text = with_planes ? planes_text(map) + "\n" : "";
    if (!measures.empty())
        text +=
            left("", 17) + left("plane a", 15) + left("plane b", 15) + left("angle deg", 19) + "distance m\n";
    for (const Measure& measure : measures) text += measure_text(map, measure);
    if (measures.empty())
        text +=
            "nothing of its rooms can be measured: no floor, ceiling or walls lie opposite; ids, or --all, "
            "give pairs\n";
    return text + "\nThe " + kCertainty + " Distances are of planes within " +
           fixed(degrees(kParallel_rad), 0) + " deg of parallel.\n";
}

Json measures_json(const PlaneMap& map, const std::vector<Measure>& measures) {
    Json planes = Json::array(), rows = Json::array();
    for (const MapPlane& plane : map.planes) planes.push_back(plane_json(map, plane));
    for (const Measure& measure : measures) rows.push_back(measure_json(map, measure));
    return {{"format", "planemap measures 1"},
            {"certainty", std::string("The ") + kCertainty},
            {"planes", std::move(planes)},
            {"measures", std::move(rows)}};
}

std::string measures_csv(const PlaneMap& map, const std::vector<Measure>& measures) {
    constexpr const char* kColumns[] = {
        "angle_deg",   "angle_sigma_deg", "distance_m",     "distance_sigma_m", "least_m",          "most_m",
        "opposite_m2", "sides",           "gap_m",          "area_m2",          "inferred_area_m2", "rms_m",
        "keyframes",   "offset_sigma_m",  "why_no_distance"};
    std::string text = "kind,plane_a,label_a,plane_b,label_b";
    for (const char* column : kColumns) text += std::string(",") + column;
    const auto add = [&](const std::string& start, const Json& json) {
        text += "\n" + start;
        for (const char* column : kColumns) text += "," + cell(json.value(column, Json()));
    };
    for (const MapPlane& plane : map.planes)
        add("plane," + std::to_string(plane.id) + "," + label_name(plane.label) + ",,",
            plane_json(map, plane));
    for (const Measure& measure : measures) {
        const Json json = measure_json(map, measure);
        add(measure.kind + "," + std::to_string(measure.a) + "," + cell(json["labels"][0]) + "," +
                std::to_string(measure.b) + "," + cell(json["labels"][1]),
            json);
    }
    return text + "\n";
}

}  // namespace planemap
