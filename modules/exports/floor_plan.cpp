// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "exports/exports.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

namespace {

using Json = nlohmann::ordered_json;

/// GDAL and QGIS take coordinates without a system for degrees; they read this as a plane with metres.
constexpr const char* kFrame =
    "ENGCRS[\"planemap level frame\",EDATUM[\"start of the map\"],CS[Cartesian,2],AXIS[\"x\",east],"
    "AXIS[\"y\",north],LENGTHUNIT[\"metre\",1]]";

constexpr double kUpright = 0.35;  // sine of the slope up to which a plane is drawn as a line

double rounded(double metres) {
    return std::round(1e3 * metres) / 1e3 + 0.0;  // no negative zero
}

Json position(const Eigen::Vector2d& p) {
    return {rounded(p.x()), rounded(p.y())};
}

Json feature(const Json& id, const std::string& type, Json coordinates, Json properties) {
    return {{"type", "Feature"},
            {"id", id},
            {"properties", std::move(properties)},
            {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}};
}

/// Several pieces are a Multi... geometry, one is itself.
Json feature_of_pieces(const Json& id, const std::string& type, Json pieces, Json properties) {
    if (pieces.size() == 1) return feature(id, type, pieces[0], std::move(properties));
    return feature(id, "Multi" + type, std::move(pieces), std::move(properties));
}

Json line_pieces(const MapPlane& plane, const Eigen::Matrix3d& level) {
    Json pieces = Json::array();
    for (const auto& [from, to] : footprint(plane, level)) pieces.push_back({position(from), position(to)});
    return pieces;
}

Json polygon_pieces(const std::vector<std::vector<Eigen::Vector3d>>& rings_level) {
    std::vector<Ring> rings;
    for (const auto& ring : rings_level) {
        Ring& flat = rings.emplace_back();
        for (const Eigen::Vector3d& p : ring) flat.push_back(p.head<2>());
    }
    Json pieces = Json::array();
    for (const Part& part : parts_of(rings)) {
        Json polygon = Json::array();
        for (const Ring& ring : part) {
            Json closed = Json::array();
            for (const Eigen::Vector2d& p : ring) closed.push_back(position(p));
            closed.push_back(position(ring.front()));
            polygon.push_back(std::move(closed));
        }
        pieces.push_back(std::move(polygon));
    }
    return pieces;
}

Json plane_feature(const MapPlane& plane, const Eigen::Matrix3d& level, double floor_height) {
    auto rings = world_rings(plane);
    double low = 1e300, high = -1e300;
    for (auto& ring : rings) {
        for (Eigen::Vector3d& p : ring) {
            p = level * p;
            low = std::min(low, p.z() - floor_height);
            high = std::max(high, p.z() - floor_height);
        }
    }
    const Json properties = {{"label", label_name(plane.label)},
                             {"plane", plane.id},
                             {"low_m", rounded(low)},
                             {"high_m", rounded(high)},
                             {"area_m2", rounded(static_cast<double>(plane.area))}};
    const double upward = level.row(2).dot(plane.normal.cast<double>());
    return std::abs(upward) < kUpright
               ? feature_of_pieces(plane.id, "LineString", line_pieces(plane, level), properties)
               : feature_of_pieces(plane.id, "Polygon", polygon_pieces(rings), properties);
}

Json trajectory_positions(const Trajectory& trajectory, const Eigen::Matrix3d& level) {
    Json positions = Json::array();
    for (const StampedPose& pose : trajectory) {
        const Eigen::Vector3d p = level * pose.world_from_camera.translation();
        if (!p.allFinite()) continue;
        const Json next = position(p.head<2>());
        if (positions.empty() || positions.back() != next) positions.push_back(next);
    }
    return positions;
}

}  // namespace

std::string floor_plan_geojson(const PlaneMap& map, const Trajectory& trajectory) {
    const Eigen::Matrix3d level = level_from_world(map, up_of(map, trajectory));
    const std::vector<const MapPlane*> planes = drawable_planes(map);
    const MapPlane* floor = nullptr;
    for (const MapPlane* plane : planes) {
        if (plane->label == PlaneLabel::kFloor && (floor == nullptr || plane->area > floor->area))
            floor = plane;
    }
    const double floor_height = floor != nullptr ? level.row(2).dot(floor->center.cast<double>()) : 0;

    Json features = Json::array();
    for (const PlaneLabel label : {PlaneLabel::kFloor, PlaneLabel::kHorizontal, PlaneLabel::kOther,
                                   PlaneLabel::kVertical, PlaneLabel::kWall}) {
        for (const MapPlane* plane : planes)
            if (plane->label == label) features.push_back(plane_feature(*plane, level, floor_height));
    }
    const Json walked = trajectory_positions(trajectory, level);
    if (walked.size() > 1)
        features.push_back(feature("trajectory", "LineString", walked, {{"label", "trajectory"}}));

    Json rows = Json::array();
    for (int i = 0; i < 3; ++i) {
        Json row = Json::array();
        for (int j = 0; j < 3; ++j) row.push_back(std::round(1e9 * level(i, j)) / 1e9 + 0.0);
        rows.push_back(row);
    }
    const std::string heights =
        floor != nullptr ? "plane " + std::to_string(floor->id) + " (floor)" : "the world's origin";
    const Json crs = {{"type", "name"}, {"properties", {{"name", kFrame}}}};
    const std::string frame =
        "local, metres, not degrees: x and y level, z up; position = rotation_level_from_world * p_world; "
        "heights are above " +
        heights;
    std::string text = "{\"type\": \"FeatureCollection\",\n \"crs\": " + crs.dump() +
                       ",\n \"frame\": " + Json(frame).dump() +
                       ",\n \"rotation_level_from_world\": " + rows.dump() + ",\n \"features\": [";
    for (std::size_t i = 0; i < features.size(); ++i)
        text += (i == 0 ? "\n  " : ",\n  ") + features[i].dump();
    return text + "\n ]}\n";
}

}  // namespace planemap::exports
