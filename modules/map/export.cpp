// SPDX-License-Identifier: BSD-3-Clause
#include "map/export.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "map/export_parts.hpp"

namespace planemap::map {

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

Json plane_json(const MapPlane& plane, const Sightings& sightings) {
    const PlanarRegion region = plane.region();
    Json corners = Json::array(), outline = Json::array();
    for (const Eigen::Vector3d& corner : region.box.corners()) corners.push_back(vector(corner));
    for (const Ring& ring : region.outline.rings) {
        Json points = Json::array();
        for (const Eigen::Vector2d& v : ring)
            points.push_back(vector(region.box.frame_from_box * Eigen::Vector3d(v.x(), v.y(), 0)));
        outline.push_back(std::move(points));
    }
    Json json;
    json["id"] = plane.id;
    json["label"] = label_name(plane.label);
    json["normal"] = vector(region.plane.normal, 1e9);
    json["d"] = number(region.plane.d);
    json["inliers"] = number(plane.inliers, 1);
    json["rms"] = number(region.rms);
    json["area"] = number(plane.area);
    json["center"] = vector(region.box.frame_from_box.translation());
    json["box_corners"] = std::move(corners);
    json["outline"] = std::move(outline);
    const auto seen = sightings.find(plane.id);
    json["keyframe_count"] = plane.keyframes;
    json["keyframes"] = seen == sightings.end() ? std::vector<int>{} : seen->second;
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

void put(std::string& bytes, const auto& value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

}  // namespace

Rgb plane_color(int id) {
    // Hues a golden angle apart, in three shades: neighbouring ids never look alike.
    const double hue = std::fmod(id * 0.6180339887498949, 1.0) + (id < 0 ? 1 : 0);
    const double value = std::array{0.92, 0.78, 0.85}[static_cast<std::size_t>(std::abs(id % 3))];
    const auto channel = [&](double offset) {
        const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (hue - offset));
        return static_cast<std::uint8_t>(std::lround(255 * value * (0.42 + 0.58 * wave)));
    };
    return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

std::string planes_json(const PlaneMap& map, const Sightings& sightings) {
    std::string text = "{\n \"format\": \"planemap planes 1\",\n";
    text +=
        " \"units\": \"metres; world frame; n.p + d = 0 with the normal towards where the plane was seen "
        "from\",\n";
    text += " \"utime\": " + std::to_string(map.utime) + ",\n \"revision\": " + std::to_string(map.revision) +
            ",\n";
    text += " \"up\": " + (map.up.isZero() ? Json() : vector(map.up.cast<double>(), 1e9)).dump() + ",\n";
    text +=
        " \"planes\": " + lines_of(map.planes, [&](auto& plane) { return plane_json(plane, sightings); }) +
        ",\n";
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

namespace {

/// The parts of a PLY file, in the order of its elements.
class Ply {
  public:
    int vertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, const Rgb& color) {
        for (const Eigen::Vector3d& v : {position, normal})
            for (const double value : {v.x(), v.y(), v.z()}) put(vertices_, static_cast<float>(value));
        for (const std::uint8_t value : {color.r, color.g, color.b}) put(vertices_, value);
        return vertex_count_++;
    }
    void face(int a, int b, int c) {
        put(faces_, std::uint8_t{3});
        for (const std::int32_t i : {a, b, c}) put(faces_, i);
        ++face_count_;
    }
    void edge(int a, int b) {
        for (const std::int32_t i : {a, b}) put(edges_, i);
        ++edge_count_;
    }
    void comment(const std::string& text) { comments_ += "comment " + text + "\n"; }

    std::string bytes() const {
        std::string text = "ply\nformat binary_little_endian 1.0\n" + comments_ + "element vertex " +
                           std::to_string(vertex_count_) +
                           "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
                           "property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
                           "property uchar blue\nelement face " +
                           std::to_string(face_count_) + "\nproperty list uchar int vertex_indices\n";
        if (edge_count_ > 0) {
            text += "element edge " + std::to_string(edge_count_) +
                    "\nproperty int vertex1\nproperty int vertex2\n";
        }
        return text + "end_header\n" + vertices_ + faces_ + edges_;
    }

  private:
    std::string vertices_, faces_, edges_, comments_;
    int vertex_count_ = 0, face_count_ = 0, edge_count_ = 0;
};

}  // namespace

std::string planes_ply(const PlaneMap& map, const Trajectory& trajectory) {
    const UprightFrame frame = upright_frame(map, trajectory);
    const Eigen::Matrix3d& level = frame.level_from_world;
    Ply ply;
    ply.comment("planemap: planes of a map");
    for (const std::string& note : frame.notes(level, 'z')) ply.comment(note);
    for (const MapPlane* plane : drawable_planes(map)) {
        const PlaneMesh mesh = mesh_of(*plane);
        const Eigen::Vector3d normal = level * plane->normal.cast<double>().normalized();
        int first = 0;
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const int index =
                ply.vertex(level * mesh.vertices[i].cast<double>(), normal, plane_color(plane->id));
            if (i == 0) first = index;
        }
        for (const auto& [a, b, c] : mesh.triangles) ply.face(first + a, first + b, first + c);
        ply.comment("plane " + std::to_string(plane->id) + " " + label_name(plane->label) + ", " +
                    std::to_string(mesh.triangles.size()) + " faces");
    }
    int last = -1;
    for (const Eigen::Vector3d& p : walked(trajectory)) {
        const int index = ply.vertex(level * p, Eigen::Vector3d::UnitZ(), kTrajectoryColor);
        if (last >= 0) {
            ply.edge(last, index);
        } else {
            ply.comment("trajectory: the vertices from " + std::to_string(index) + " on, joined by edges");
        }
        last = index;
    }
    return ply.bytes();
}

}  // namespace planemap::map
