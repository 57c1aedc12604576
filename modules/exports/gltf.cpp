// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "exports/exports.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

namespace {

using Json = nlohmann::ordered_json;

// Of the specification.
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126, kUint32 = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963,
              kLineStrip = 3;

void put_word(std::string& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
}

void put_vector(std::string& bytes, const Eigen::Vector3f& v) {
    for (const float value : {v.x(), v.y(), v.z()}) put_word(bytes, std::bit_cast<std::uint32_t>(value));
}

Json json_of(const Eigen::Vector3f& v) {
    return {v.x(), v.y(), v.z()};
}

/// glTF colours are linear, screen colours are not.
double linear(std::uint8_t channel) {
    const double value = channel / 255.0;
    const double light = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    return std::round(1e4 * light) / 1e4;
}

/// The node that turns the world to glTF's axes, y up, z level.
Json root_node(const UprightFrame& frame) {
    const Eigen::Matrix3d y_up = frame.y_up_from_world();
    const Eigen::Quaterniond q(y_up);
    Json rotation = Json::array(), notes = Json::array();
    for (const double value : {q.x(), q.y(), q.z(), q.w()})
        rotation.push_back(std::round(1e9 * value) / 1e9 + 0.0);
    for (const std::string& note : frame.notes(y_up, 'y')) notes.push_back(note);
    return {{"name", "planemap"}, {"rotation", rotation}, {"extras", {{"frame", notes}}}};
}

Json material(const std::string& name, const Rgb& color) {
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {linear(color.r), linear(color.g), linear(color.b), 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}},
            {"doubleSided", true}};
}

/// Collects meshes into the arrays of a glTF file.
class Scene {
  public:
    void add(const MapPlane& plane) {
        const PlaneMesh mesh = mesh_of(plane);
        if (mesh.triangles.empty()) return;
        const std::string name = plane_name(plane);
        const int count = static_cast<int>(mesh.vertices.size()), index = static_cast<int>(meshes.size());
        Eigen::Vector3f low = mesh.vertices[0], high = low;
        const int first_accessor = static_cast<int>(accessors.size());
        accessors.push_back(accessor(0, positions.size(), kFloat, count, "VEC3"));
        accessors.push_back(accessor(1, normals.size(), kFloat, count, "VEC3"));
        accessors.push_back(
            accessor(2, indices.size(), kUint32, static_cast<int>(3 * mesh.triangles.size()), "SCALAR"));
        for (const Eigen::Vector3f& v : mesh.vertices) {
            put_vector(positions, v);
            put_vector(normals, plane.normal.normalized().eval());
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        for (const auto& triangle : mesh.triangles)
            for (const int i : triangle) put_word(indices, static_cast<std::uint32_t>(i));
        accessors[static_cast<std::size_t>(first_accessor)]["min"] = json_of(low);
        accessors[static_cast<std::size_t>(first_accessor)]["max"] = json_of(high);

        materials.push_back(material("plane_" + std::to_string(plane.id), id_color(plane.id)));
        const Json attributes = {{"POSITION", first_accessor}, {"NORMAL", first_accessor + 1}};
        const Json primitive = {
            {"attributes", attributes}, {"indices", first_accessor + 2}, {"material", index}};
        meshes.push_back({{"name", name}, {"primitives", Json::array({primitive})}});
        nodes.push_back({{"name", name},
                         {"mesh", index},
                         {"extras",
                          {{"id", plane.id},
                           {"label", label_name(plane.label)},
                           {"area_m2", std::round(1e4 * static_cast<double>(plane.area)) / 1e4}}}});
    }

    void add(const std::vector<Eigen::Vector3d>& way) {
        if (way.size() < 2) return;  // a line strip has two points at least
        const int index = static_cast<int>(meshes.size());
        const Json attributes = {{"POSITION", accessors.size()}};
        Eigen::Vector3f low = way[0].cast<float>(), high = low;
        accessors.push_back(accessor(0, positions.size(), kFloat, static_cast<int>(way.size()), "VEC3"));
        for (const Eigen::Vector3d& p : way) {
            const Eigen::Vector3f v = p.cast<float>();
            put_vector(positions, v);
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        accessors.back()["min"] = json_of(low);
        accessors.back()["max"] = json_of(high);
        materials.push_back(material("trajectory", kTrajectoryColor));
        const Json primitive = {{"attributes", attributes}, {"material", index}, {"mode", kLineStrip}};
        meshes.push_back({{"name", "trajectory"}, {"primitives", Json::array({primitive})}});
        nodes.push_back({{"name", "trajectory"}, {"mesh", index}, {"extras", {{"label", "trajectory"}}}});
    }

    std::string glb(Json root) const {
        for (std::size_t i = 1; i <= nodes.size(); ++i) root["children"].push_back(i);
        Json all_nodes = Json::array({root});
        for (const Json& node : nodes) all_nodes.push_back(node);
        Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "planemap"}}},
                     {"scene", 0},
                     {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
                     {"nodes", all_nodes}};
        const std::string binary = positions + normals + indices;
        if (!binary.empty()) {  // empty arrays are not allowed
            gltf["meshes"] = meshes;
            gltf["materials"] = materials;
            gltf["accessors"] = accessors;
            gltf["bufferViews"] = views();
            gltf["buffers"] = Json::array({{{"byteLength", binary.size()}}});
        }
        std::string text = gltf.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');

        std::string bytes;
        const std::size_t total = 20 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
        for (const std::uint32_t value : {kMagic, kVersion, static_cast<std::uint32_t>(total),
                                          static_cast<std::uint32_t>(text.size()), kJsonChunk})
            put_word(bytes, value);
        bytes += text;
        if (!binary.empty()) {
            put_word(bytes, static_cast<std::uint32_t>(binary.size()));
            put_word(bytes, kBinaryChunk);
            bytes += binary;
        }
        return bytes;
    }

  private:
    static Json accessor(int view, std::size_t offset, int component, int count, const char* type) {
        return {{"bufferView", view},
                {"byteOffset", offset},
                {"componentType", component},
                {"count", count},
                {"type", type}};
    }

    Json views() const {
        const auto view = [](std::size_t offset, std::size_t length, int target) -> Json {
            return {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}, {"target", target}};
        };
        Json all = Json::array({view(0, positions.size(), kArrayBuffer)});
        if (!indices.empty()) {  // there is more than a trajectory
            all.push_back(view(positions.size(), normals.size(), kArrayBuffer));
            all.push_back(view(positions.size() + normals.size(), indices.size(), kElementArrayBuffer));
            all[1]["byteStride"] = 3 * sizeof(float);
        }
        all[0]["byteStride"] = 3 * sizeof(float);
        return all;
    }

    std::string positions, normals, indices;  ///< little-endian
    std::vector<Json> accessors, materials, meshes, nodes;
};

}  // namespace

std::string planes_glb(const PlaneMap& map, const Trajectory& trajectory) {
    Scene scene;
    for (const MapPlane* plane : drawable_planes(map)) scene.add(*plane);
    scene.add(walked(trajectory));
    return scene.glb(root_node(upright_frame(map, trajectory)));
}

}  // namespace planemap::exports
