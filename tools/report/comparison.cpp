// SPDX-License-Identifier: BSD-3-Clause
#include "report/comparison.hpp"

#include "core/geometry/angle.hpp"
#include "evaluate/plane_matching.hpp"
#include "report/figures.hpp"
#include "report/world_frames.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

void add_figures(const Json& a, const Json& b, Json& comparison) {
    Json differ = Json::array();
    int alike = 0;
    std::vector<Figure> figures = figures_of(a);
    for (const Figure& figure : figures_of(b)) {
        const bool known = std::any_of(figures.begin(), figures.end(),
                                       [&](const Figure& other) { return other.pointer == figure.pointer; });
        if (!known) figures.push_back(figure);
    }
    for (const Figure& figure : figures) {
        const std::optional<double> of_a = value_of(a, figure), of_b = value_of(b, figure);
        if (!of_a && !of_b) continue;
        if (of_a == of_b)
            ++alike;
        else
            differ.push_back({{"name", figure.name},
                              {"pointer", figure.pointer},
                              {"a", number(of_a)},
                              {"b", number(of_b)},
                              {"a_text", figure_text(of_a, figure.kind)},
                              {"b_text", figure_text(of_b, figure.kind)},
                              {"change_text", change_text(of_a, of_b, figure.kind)}});
    }
    comparison["figures"] = differ;
    comparison["figures_alike"] = alike;
}

/// Options whose values differ; but where the results went to, which says nothing.
Json options_that_differ(const Json& a, const Json& b) {
    const Json of_a = a.value("options", Json()), of_b = b.value("options", Json());
    Json differ = Json::array();
    if (!of_a.is_object() || !of_b.is_object()) return differ;
    Json names = of_a;
    names.update(of_b);
    for (const auto& [flag, unused] : names.items()) {
        const Json value_a = of_a.value(flag, Json()), value_b = of_b.value(flag, Json());
        if (flag != "output" && value_a != value_b)
            differ.push_back({{"flag", flag}, {"a", value_a}, {"b", value_b}});
    }
    return differ;
}

Json plane_json(const PlaneMap& map, int id) {
    const MapPlane* plane = map.find(id);
    return {{"id", id}, {"label", label_name(plane->label)}, {"area", plane->area}};
}

Json planes_json(const PlaneMap& a, const PlaneMap& b, const evaluation::PlaneMatches& matches) {
    Json in_place = Json::array(), moved = Json::array(), appeared = Json::array(), gone = Json::array();
    for (const evaluation::PlaneMatch& pair : matches.pairs) {
        Json entry{{"a", plane_json(a, pair.a)},
                   {"b", plane_json(b, pair.b)},
                   {"offset_m", pair.offset_m},
                   {"angle_deg", degrees(pair.angle)}};
        (pair.is_in_place() ? in_place : moved).push_back(std::move(entry));
    }
    for (const int id : matches.only_a) gone.push_back(plane_json(a, id));
    for (std::size_t i = 0; i < matches.only_b.size(); ++i) {
        Json entry = plane_json(b, matches.only_b[i]);
        entry["lies_on_a"] = matches.on_a[i] < 0 ? Json() : Json(matches.on_a[i]);
        appeared.push_back(std::move(entry));
    }
    return {{"in_place", in_place}, {"moved", moved}, {"appeared", appeared}, {"gone", gone}};
}

void add_planes(const Subject& a, const Subject& b, Json& comparison) {
    comparison["world_frames"] = {{"are_one", false}, {"why", ""}};
    comparison["planes"] = nullptr;
    const std::optional<PlaneMap> map_a = a.map(), map_b = b.map();
    if (!map_a || !map_b) {
        comparison["world_frames"]["why"] = (map_a ? b : a).path.string() + " holds no plane_map.lcmlog";
        return;
    }
    const evaluation::PlaneMatches matches = evaluation::match_planes(*map_a, *map_b);
    const WorldFrames frames = compare_world_frames(*map_a, a.trajectory(), *map_b, b.trajectory(), matches);
    comparison["world_frames"] = {{"are_one", frames.are_one}, {"why", frames.why}};
    if (frames.are_one) comparison["planes"] = planes_json(*map_a, *map_b, matches);
}

}  // namespace

Json compare(const Subject& a, const Subject& b) {
    Json comparison{{"a", a.path.string()}, {"b", b.path.string()}};
    add_figures(a.report, b.report, comparison);
    comparison["options"] = options_that_differ(a.report, b.report);
    add_planes(a, b, comparison);
    return comparison;
}

}  // namespace planemap
