// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <sstream>

#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using scene::corner;
using scene::walk;
using ::testing::HasSubstr;

struct Ply {
    std::vector<Eigen::Vector3f> vertices, normals;
    std::vector<std::array<std::int32_t, 3>> faces;
    std::vector<std::array<std::int32_t, 2>> edges;
};

Ply read_ply(const std::string& bytes) {
    Ply ply;
    std::istringstream in(bytes);
    std::string line;
    std::size_t vertices = 0, faces = 0, edges = 0;
    std::getline(in, line);
    EXPECT_EQ(line, "ply");
    while (std::getline(in, line) && line != "end_header") {
        std::sscanf(line.c_str(), "element vertex %zu", &vertices);
        std::sscanf(line.c_str(), "element face %zu", &faces);
        std::sscanf(line.c_str(), "element edge %zu", &edges);
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        std::array<float, 6> values;
        in.read(reinterpret_cast<char*>(values.data()), sizeof values);
        in.ignore(3);
        ply.vertices.emplace_back(values[0], values[1], values[2]);
        ply.normals.emplace_back(values[3], values[4], values[5]);
    }
    for (std::size_t i = 0; i < faces; ++i) {
        EXPECT_EQ(in.get(), 3);
        std::array<std::int32_t, 3> face;
        in.read(reinterpret_cast<char*>(face.data()), sizeof face);
        ply.faces.push_back(face);
    }
    for (std::size_t i = 0; i < edges; ++i) {
        std::array<std::int32_t, 2> edge;
        in.read(reinterpret_cast<char*>(edge.data()), sizeof edge);
        ply.edges.push_back(edge);
    }
    EXPECT_TRUE(in.good());
    EXPECT_EQ(in.peek(), std::char_traits<char>::eof());
    return ply;
}

TEST(PlanesPly, HasTheAreaAndNormalsOfThePlanes) {
    const PlaneMap map = corner();
    const Ply ply = read_ply(planes_ply(map, walk()));
    double area = 0, expected = 0;
    for (const auto& face : ply.faces) {
        std::array<Eigen::Vector3f, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_LT(static_cast<std::size_t>(face[i]), ply.vertices.size());
            p[i] = ply.vertices[static_cast<std::size_t>(face[i])];
        }
        const Eigen::Vector3f twice = (p[1] - p[0]).cross(p[2] - p[0]);
        EXPECT_GT(twice.dot(ply.normals[static_cast<std::size_t>(face[0])]), 0)
            << "faces turn like their normal";
        area += 0.5 * static_cast<double>(twice.norm());
    }
    for (const MapPlane& plane : map.planes) expected += static_cast<double>(plane.area);
    EXPECT_NEAR(area, expected, 1e-5);
    EXPECT_TRUE(read_ply(planes_ply({}, {})).faces.empty());
    EXPECT_THAT(planes_ply(map, walk()), HasSubstr("comment plane 3 wall, "));
    PlaneMap spoilt = map;
    spoilt.planes[1].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    EXPECT_LT(read_ply(planes_ply(spoilt, walk())).faces.size(), ply.faces.size());
}

TEST(PlanesPly, StandsUprightAndCarriesTheTrajectory) {
    for (const PlaneMap& map : scene::maps_of_several_ups()) {
        const std::string bytes = planes_ply(map, walk());
        const Eigen::Matrix3d rotation = scene::said_rotation(bytes);
        EXPECT_NEAR(rotation.determinant(), 1, 1e-6);
        EXPECT_NEAR((rotation * scene::expected_up(map, walk())).z(), 1, 1e-6);
        EXPECT_THAT(bytes, HasSubstr(map.up.isZero() ? "z is against the first camera's y"
                                                     : "as the planes tell it"));
        const Ply ply = read_ply(bytes);
        // The floor's corners, and the camera's way, each turned from the world.
        const Pose world_from_floor = map.planes[0].world_from_plane();
        for (std::size_t i = 0; i < 4; ++i) {
            const Eigen::Vector3d world = rotation.transpose() * ply.vertices[i].cast<double>();
            EXPECT_NEAR((world_from_floor.inverse() * world).z(), 0, 1e-5);
            EXPECT_NEAR(world.head<2>().cwiseAbs().minCoeff(), 1, 1e-5);
        }
        ASSERT_EQ(ply.edges.size(), 4u);
        for (std::size_t i = 0; i < ply.edges.size(); ++i) {
            for (const std::size_t end : {0u, 1u}) {
                const Eigen::Vector3d at =
                    ply.vertices[static_cast<std::size_t>(ply.edges[i][end])].cast<double>();
                EXPECT_TRUE(at.isApprox(rotation * walk()[i + end].world_from_camera.translation(), 1e-5));
            }
        }
    }
}

TEST(PointsPly, HasEachPointWithItsColourAndPlane) {
    const std::vector<CloudPoint> points{{{1, 2, 3}, {4, 5, 6}, 7}, {{-1, 0.5f, 0}, {255, 0, 128}, -1}};
    const std::string bytes = points_ply(points, "of a test");
    const std::string end = "end_header\n";
    const std::size_t at = bytes.find(end) + end.size();
    EXPECT_EQ(
        bytes.substr(0, at),
        "ply\nformat binary_little_endian 1.0\ncomment of a test\nelement vertex 2\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int plane\nend_header\n");
    ASSERT_EQ(bytes.size(), at + 2 * 19);
    for (std::size_t i = 0; i < 2; ++i) {
        const char* vertex = bytes.data() + at + 19 * i;
        std::array<float, 3> position;
        std::int32_t plane = 0;
        std::memcpy(position.data(), vertex, 12);
        std::memcpy(&plane, vertex + 15, 4);
        EXPECT_EQ(Eigen::Vector3f(position[0], position[1], position[2]), points[i].position);
        EXPECT_EQ(static_cast<std::uint8_t>(vertex[12]), points[i].color.r);
        EXPECT_EQ(static_cast<std::uint8_t>(vertex[14]), points[i].color.b);
        EXPECT_EQ(plane, points[i].plane);
    }
    EXPECT_THAT(
        points_ply({}, "none"),
        ::testing::EndsWith("element vertex 0\n" + bytes.substr(bytes.find("property float x"),
                                                                at - bytes.find("property float x"))));
}

}  // namespace
}  // namespace planemap::exports
