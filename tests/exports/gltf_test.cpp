// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using scene::corner;
using Json = nlohmann::json;

struct Glb {
    Json json;
    std::string binary;

    template <typename T>
    T at(std::size_t offset) const {
        T value{};
        EXPECT_LE(offset + sizeof value, binary.size());
        if (offset + sizeof value <= binary.size()) std::memcpy(&value, binary.data() + offset, sizeof value);
        return value;
    }
    std::size_t offset(const Json& accessor) const {
        const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        return view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
    }
    Eigen::Vector3f vector(const Json& accessor, std::size_t index) const {
        const std::size_t at_byte = offset(accessor) + 12 * index;
        return {at<float>(at_byte), at<float>(at_byte + 4), at<float>(at_byte + 8)};
    }
};

Glb read_glb(const std::string& bytes) {
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return std::size_t{value};
    };
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes.size());
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    const std::size_t length = word(12);
    EXPECT_EQ(length % 4, 0u);
    Glb glb{Json::parse(bytes.substr(20, length)), {}};
    if (20 + length < bytes.size()) {
        EXPECT_EQ(word(20 + length), bytes.size() - 28 - length);
        EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
        glb.binary = bytes.substr(28 + length);
        EXPECT_EQ(glb.json["buffers"][0]["byteLength"], glb.binary.size());
    }
    return glb;
}

TEST(PlanesGlb, HasANodeAPlaneWithItsArea) {
    const PlaneMap map = corner();
    const Glb glb = read_glb(planes_glb(map, {}));
    ASSERT_EQ(glb.json["nodes"].size(), 4u);
    EXPECT_EQ(glb.json["nodes"][0]["children"], Json::parse("[1, 2, 3]"));
    for (std::size_t i = 0; i < map.planes.size(); ++i) {
        const MapPlane& plane = map.planes[i];
        const Json& node = glb.json["nodes"][i + 1];
        EXPECT_EQ(node["name"], "plane_" + std::to_string(plane.id) + "_" + label_name(plane.label));
        EXPECT_EQ(node["extras"]["id"], plane.id);
        EXPECT_EQ(node["extras"]["label"], label_name(plane.label));
        const Json& primitive = glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
        EXPECT_EQ(glb.json["materials"][primitive["material"].get<std::size_t>()]["name"],
                  "plane_" + std::to_string(plane.id));
        const auto accessor = [&](const Json& index) {
            return glb.json["accessors"][index.get<std::size_t>()];
        };
        const Json positions = accessor(primitive["attributes"]["POSITION"]),
                   normals = accessor(primitive["attributes"]["NORMAL"]),
                   indices = accessor(primitive["indices"]);
        Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9f), high = -low;
        for (std::size_t k = 0; k < positions["count"].get<std::size_t>(); ++k) {
            low = low.cwiseMin(glb.vector(positions, k));
            high = high.cwiseMax(glb.vector(positions, k));
            EXPECT_EQ(glb.vector(normals, k), plane.normal.normalized());
        }
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(positions["min"][k].get<float>(), low[static_cast<int>(k)]);
            EXPECT_EQ(positions["max"][k].get<float>(), high[static_cast<int>(k)]);
        }
        float area = 0;
        for (std::size_t k = 0; k < indices["count"].get<std::size_t>(); k += 3) {
            std::array<Eigen::Vector3f, 3> p;
            for (std::size_t c = 0; c < 3; ++c)
                p[c] = glb.vector(positions, glb.at<std::uint32_t>(glb.offset(indices) + 4 * (k + c)));
            area += 0.5f * (p[1] - p[0]).cross(p[2] - p[0]).dot(plane.normal);
        }
        EXPECT_NEAR(area, plane.area, 1e-4);
    }
    EXPECT_EQ(planes_glb(map, {}), planes_glb(corner(), {}));
}

TEST(PlanesGlb, StandsUprightAndCarriesTheTrajectory) {
    const Trajectory walk = scene::walk();
    for (const PlaneMap& map : scene::maps_of_several_ups()) {
        const Glb glb = read_glb(planes_glb(map, walk));
        const auto q = glb.json["nodes"][0]["rotation"].get<std::vector<double>>();
        const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
        EXPECT_NEAR(rotation.norm(), 1, 1e-6);
        EXPECT_NEAR((rotation * scene::expected_up(map, walk)).y(), 1, 1e-6);
        EXPECT_TRUE(scene::said_rotation(glb.json["nodes"][0]["extras"]["frame"].dump())
                        .isApprox(rotation.toRotationMatrix(), 1e-6));
        const Json& node = glb.json["nodes"].back();
        EXPECT_EQ(node["name"], "trajectory");
        const Json& primitive = glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
        EXPECT_EQ(primitive["mode"], 3) << "a line strip";
        const Json& positions = glb.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
        ASSERT_EQ(positions["count"], walk.size());
        for (std::size_t i = 0; i < walk.size(); ++i)
            EXPECT_TRUE(glb.vector(positions, i)
                            .isApprox(walk[i].world_from_camera.translation().cast<float>(), 1e-5f));
    }
}

TEST(PlanesGlb, OfATrajectoryAlone) {
    const Glb glb = read_glb(planes_glb({}, scene::walk()));
    EXPECT_EQ(glb.json["bufferViews"].size(), 1u) << "empty ones are not allowed";
    EXPECT_EQ(glb.json["meshes"].size(), 1u);
}

TEST(PlanesGlb, OfAnEmptyMapAndOfNan) {
    const Glb empty = read_glb(planes_glb({}, {}));
    EXPECT_TRUE(empty.binary.empty());
    EXPECT_FALSE(empty.json.contains("meshes"));
    PlaneMap map = corner();
    map.planes[0].normal.setConstant(std::numeric_limits<float>::quiet_NaN());
    const Glb rest = read_glb(planes_glb(map, {}));
    EXPECT_EQ(rest.json["meshes"].size(), 2u);
    EXPECT_EQ(rest.json.dump().find("null"), std::string::npos);
}

}  // namespace
}  // namespace planemap::exports
