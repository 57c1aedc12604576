// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <sstream>

#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using scene::corner;
using scene::walk;
using ::testing::HasSubstr;
using ::testing::Not;

struct Obj {
    std::vector<Eigen::Vector3d> vertices, normals;
    std::map<std::string, double> areas;           ///< by object; negative if faces turn against the normal
    std::map<std::string, std::string> materials;  ///< by object
    std::vector<std::pair<std::size_t, std::size_t>> lines;
};

Obj read_obj(const std::string& text) {
    Obj obj;
    std::istringstream lines(text);
    std::string object;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream in(line);
        std::string keyword;
        in >> keyword;
        Eigen::Vector3d v;
        if (keyword == "v" && in >> v.x() >> v.y() >> v.z()) obj.vertices.push_back(v);
        if (keyword == "vn" && in >> v.x() >> v.y() >> v.z()) obj.normals.push_back(v);
        if (keyword == "o") in >> object;
        if (keyword == "usemtl") in >> obj.materials[object];
        std::size_t from = 0, to = 0;
        if (keyword == "l" && in >> from >> to) obj.lines.emplace_back(from, to);
        if (keyword != "f") continue;
        std::array<Eigen::Vector3d, 3> p;
        std::size_t vertex = 0, normal = 0;
        char slash = 0;
        for (Eigen::Vector3d& corner : p) {
            in >> vertex >> slash >> slash >> normal;
            corner = obj.vertices.at(vertex - 1);
        }
        EXPECT_FALSE(in.fail()) << line;
        obj.areas[object] += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).dot(obj.normals.at(normal - 1));
    }
    return obj;
}

TEST(PlanesObj, HasAnObjectAPlaneWithItsArea) {
    const PlaneMap map = corner();
    const Obj obj = read_obj(planes_obj(map, walk()));
    ASSERT_EQ(obj.areas.size(), 3u);
    EXPECT_NEAR(obj.areas.at("plane_1_floor"), map.planes[0].area, 1e-3);
    EXPECT_NEAR(obj.areas.at("plane_3_wall"), map.planes[1].area, 1e-3);
    EXPECT_NEAR(obj.areas.at("plane_12_ceiling"), map.planes[2].area, 1e-3);
    for (const auto& [object, material] : obj.materials)
        EXPECT_THAT(planes_mtl(map), HasSubstr("newmtl " + material + "\nKd 0."));
    EXPECT_THAT(planes_obj(map, walk()), HasSubstr("mtllib planes.mtl\n"));
    EXPECT_THAT(planes_obj(map, walk(), "a.mtl"), HasSubstr("mtllib a.mtl\n"));
    EXPECT_EQ(planes_obj(map, walk()), planes_obj(corner(), walk()));
}

TEST(PlanesObj, StandsUprightAndCarriesTheTrajectory) {
    for (const PlaneMap& map : scene::maps_of_several_ups()) {
        const std::string text = planes_obj(map, walk());
        const Eigen::Matrix3d rotation = scene::said_rotation(text);
        EXPECT_NEAR(rotation.determinant(), 1, 1e-6);
        EXPECT_NEAR((rotation * scene::expected_up(map, walk())).y(), 1, 1e-6);
        EXPECT_THAT(
            text, HasSubstr(map.up.isZero() ? "y is against the first camera's y" : "as the planes tell it"));
        const Obj obj = read_obj(text);
        EXPECT_TRUE(obj.normals[0].isApprox(rotation * Eigen::Vector3d::UnitZ(), 1e-5)) << "of the floor";
        ASSERT_EQ(obj.lines.size(), 4u);
        EXPECT_EQ(obj.materials.at("trajectory"), "trajectory");
        for (std::size_t i = 0; i < obj.lines.size(); ++i) {
            const auto [from, to] = obj.lines[i];
            EXPECT_TRUE(obj.vertices.at(from - 1).isApprox(
                rotation * walk()[i].world_from_camera.translation(), 1e-4));
            EXPECT_TRUE(obj.vertices.at(to - 1).isApprox(
                rotation * walk()[i + 1].world_from_camera.translation(), 1e-4));
        }
    }
}

TEST(PlanesObj, OfAnEmptyMapAndOfNan) {
    EXPECT_TRUE(read_obj(planes_obj({}, {})).vertices.empty());
    PlaneMap map = corner();
    map.planes[0].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(read_obj(planes_obj(map, walk())).areas.size(), 2u);
    EXPECT_THAT(planes_obj(map, walk()) + planes_mtl(map), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace planemap::exports
