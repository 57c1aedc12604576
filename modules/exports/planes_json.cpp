// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <nlohmann/json.hpp>

#include "exports/exports.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value, double per_unit = 1e6) {
    const double rounded = std::round(value * per_unit) / per_unit;
    if (!std::isfinite(rounded)) return nullptr;
    return rounded == 0 ? 0.0 : rounded;  // no negative zero
}

Json vector(const Eigen::Vector3d& v, double per_unit = 1e6) {
    return {number(v.x(), per_unit), number(v.y(), per_unit), number(v.z(), per_unit)};
}

Json keyframes_json(int id, const std::optional<Sightings>& sightings) {
    if (!sightings) return nullptr;
    const auto seen = sightings->find(id);
    return seen == sightings->end() ? std::vector<int>{} : seen->second;
}

/// Rings of points in the world.
Json rings_json(const Pose& world_from_outline, const Outline& outline) {
    Json rings = Json::array();
    for (const Ring& ring : outline.rings) {
        Json points = Json::array();
        for (const Eigen::Vector2d& v : ring)
            points.push_back(vector(world_from_outline * Eigen::Vector3d(v.x(), v.y(), 0)));
        rings.push_back(std::move(points));
    }
    return rings;
}

Json plane_json(const PlaneMap& map, const MapPlane& plane, const std::optional<Sightings>& sightings) {
    const PlanarRegion region = plane.region();
    Json corners = Json::array();
    for (const Eigen::Vector3d& corner : region.box.corners()) corners.push_back(vector(corner));
    Json json;
    json["id"] = plane.id;
    json["label"] = label_name(plane.label);
    json["normal"] = vector(region.plane.normal, 1e9);
    json["d"] = number(region.plane.d);
    json["inliers"] = number(plane.inliers, 1);
    json["rms"] = number(region.rms);
    json["area"] = number(plane.area);
    json["inferred_area"] = number(inferred_area(map, plane.id));
    json["center"] = vector(region.box.frame_from_box.translation());
    json["box_corners"] = std::move(corners);
    json["outline"] = rings_json(region.box.frame_from_box, region.outline);
    if (const MapOutline* inferred = map.inferred_of(plane.id))
        json["inferred_rings"] = rings_json(region.box.frame_from_box, inferred->rings());
    json["keyframe_count"] = plane.keyframes;
    json["keyframes"] = keyframes_json(plane.id, sightings);
    return json;
}

/// A JSON array with one element a line.
template <typename Items, typename ToJson>
std::string lines_of(const Items& items, ToJson to_json) {
    std::string text = "[";
    for (std::size_t i = 0; i < items.size(); ++i) {
        text += i == 0 ? "\n  " : ",\n  ";
        text += to_json(items[i]).dump();
    }
    return text + (items.empty() ? "]" : "\n ]");
}

}  // namespace

std::string planes_json(const PlaneMap& map, const std::optional<Sightings>& sightings) {
    std::string text = "{\n \"format\": \"planemap planes 1\",\n";
    text +=
        " \"units\": \"metres; world frame; n.p + d = 0 with the normal towards where the plane was seen "
        "from\",\n";
    text += " \"utime\": " + std::to_string(map.utime) + ",\n \"revision\": " + std::to_string(map.revision) +
            ",\n";
    text += " \"up\": " + (map.up.isZero() ? Json() : vector(map.up.cast<double>(), 1e9)).dump() + ",\n";
    text += " \"planes\": " +
            lines_of(map.planes, [&](auto& plane) { return plane_json(map, plane, sightings); }) + ",\n";
    text += " \"lines\": " + lines_of(map.lines, [](const IntersectionLine& line) {
                return Json{{"planes", {line.plane_a, line.plane_b}},
                            {"from", vector(line.from.cast<double>())},
                            {"to", vector(line.to.cast<double>())}};
            });
    text += ",\n \"points\": " + lines_of(map.points, [](const IntersectionPoint& point) {
                return Json{{"planes", point.planes}, {"position", vector(point.position.cast<double>())}};
            });
    return text + "\n}\n";
}

}  // namespace planemap::exports
