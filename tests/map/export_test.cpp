// SPDX-License-Identifier: BSD-3-Clause
#include "map/export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "map/corner.hpp"

namespace planemap::map {
namespace {

using scene::corner;
using scene::walk;
using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(PlanesJson, SaysWhatTheMapSays) {
    const PlaneMap map = corner();
    const auto json = nlohmann::json::parse(planes_json(map, {{3, {0, 3}}}));
    EXPECT_EQ(json["utime"], 42);
    EXPECT_EQ(json["up"], nlohmann::json::parse("[0.0, 0.0, 1.0]"));
    ASSERT_EQ(json["planes"].size(), 3u);
    const auto& wall = json["planes"][1];
    EXPECT_EQ(wall["id"], 3);
    EXPECT_EQ(json["planes"][0]["label"], "floor");
    EXPECT_EQ(wall["label"], "wall");
    EXPECT_NEAR(wall["normal"][0], -1, 1e-9);
    EXPECT_NEAR(wall["d"], 1, 1e-6);
    EXPECT_EQ(wall["inliers"], map.planes[1].inliers);
    EXPECT_NEAR(wall["area"], 4 - 0.35, 1e-6);
    EXPECT_EQ(wall["box_corners"].size(), 8u);
    EXPECT_EQ(wall["keyframe_count"], 2);
    EXPECT_EQ(wall["keyframes"], nlohmann::json::parse("[0, 3]"));
    ASSERT_EQ(wall["outline"].size(), 2u);
    for (const auto& ring : wall["outline"])
        for (const auto& p : ring) EXPECT_NEAR(p[0], 1, 1e-6) << "outlines are in the world";
    EXPECT_EQ(json["lines"][0]["planes"], nlohmann::json::parse("[1, 3]"));
    EXPECT_EQ(json["points"][0]["position"], nlohmann::json::parse("[1.0, 1.0, 0.0]"));
    EXPECT_EQ(planes_json(map), planes_json(corner()));
}

TEST(PlanesJson, OfAnEmptyMapAndOfNan) {
    const auto empty = nlohmann::json::parse(planes_json({}));
    EXPECT_TRUE(empty["up"].is_null());
    EXPECT_TRUE(empty["planes"].empty() && empty["lines"].empty() && empty["points"].empty());
    PlaneMap map = corner();
    map.planes[0].rms = std::numeric_limits<float>::quiet_NaN();
    map.planes[0].area = std::numeric_limits<float>::infinity();
    const auto json = nlohmann::json::parse(planes_json(map, {{3, {0, 3}}}));
    EXPECT_TRUE(json["planes"][0]["rms"].is_null());
    EXPECT_TRUE(json["planes"][0]["area"].is_null());
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

TEST(PlaneColor, TellsNeighbouringIdsApart) {
    for (int id = -2; id < 100; ++id) {
        const Rgb a = plane_color(id), b = plane_color(id + 1);
        EXPECT_GT(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 60) << id;
    }
}

TEST(Drawings, ShowPlanesAndTrajectory) {
    for (const std::string& svg : {overhead_svg(corner(), walk()), perspective_svg(corner(), walk())}) {
        EXPECT_THAT(svg, HasSubstr("<svg xmlns="));
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr(">3</text>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), Not(HasSubstr(">12</text>")))
        << "a ceiling hides what is below";
    EXPECT_EQ(overhead_svg(corner(), walk()), overhead_svg(corner(), walk()));
}

TEST(Drawings, TellTheLabels) {
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr("<title>plane 3, wall, 3.65 m²</title>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr(">wall (1)</text>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), Not(HasSubstr(">ceiling (1)</text>"))) << "not drawn";
    EXPECT_THAT(perspective_svg(corner(), walk()), HasSubstr("<title>plane 1, floor, 4.00 m²</title>"));
}

/// The attribute of the first element after `after` in the text.
std::string attribute_after(const std::string& svg, const std::string& after, const std::string& name) {
    const auto from = svg.find(name + "=\"", svg.find(after)) + name.size() + 2;
    return svg.substr(from, svg.find('"', from) - from);
}

TEST(Drawings, TheLegendHasTheColoursOfTheDrawingAndCountsAllPlanes) {
    PlaneMap map = corner();
    map.planes.push_back(
        scene::plane_of(20, {scene::facing({0.5, 0.5, 0.7}, {0, 0, 1}, {1, 0, 0}), 0.1, 0.1, {}}));
    map.planes.back().label = PlaneLabel::kHorizontal;
    map.planes.push_back(scene::plane_of(21, {scene::facing({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}}));
    map.planes.back().outline = {};
    const std::string svg = overhead_svg(map, walk());
    for (const char* text :
         {">5 planes from above</text>", ">floor (1)</text>", ">ceiling (1), not drawn</text>",
          ">horizontal (1)</text>", ">1 plane not drawn: seen from below</text>",
          ">1 without number: under 0.15 m²</text>", ">1 without outline</text>"})
        EXPECT_THAT(svg, HasSubstr(text));
    // The floor is filled with what the legend shows beside its word, the wall's line drawn with its own.
    const auto floor_at = svg.find("plane 1, floor");
    const auto shape = svg.rfind("<path", floor_at);
    const std::string fill = attribute_after(svg.substr(shape), "evenodd", "fill");
    const auto swatch = svg.rfind("<rect", svg.find(">floor (1)</text>"));
    EXPECT_EQ(attribute_after(svg.substr(swatch), "<rect", "fill"), fill);
    const auto wall = svg.rfind("<path", svg.find("plane 3, wall"));
    const auto wall_swatch = svg.rfind("<rect", svg.find(">wall (1)</text>"));
    EXPECT_EQ(attribute_after(svg.substr(wall), "<path", "stroke"),
              attribute_after(svg.substr(wall_swatch), "<rect", "fill"));
    // Beside the drawing: no shape reaches as far right as the legend.
    const double legend_x = std::stod(attribute_after(svg.substr(swatch), "<rect", "x"));
    for (auto at = svg.find(" d=\"M"); at != std::string::npos; at = svg.find(" d=\"M", at + 1)) {
        const std::string d = attribute_after(svg.substr(at), " d", "d");
        if (d.find('h') != std::string::npos) continue;  // the legend's own line
        for (auto i = d.find_first_of("ML"); i != std::string::npos; i = d.find_first_of("ML", i + 1))
            EXPECT_LT(std::stod(d.substr(i + 1)), legend_x) << d;
    }
}

TEST(Drawings, HaveATitleAndAScale) {
    const std::string above = overhead_svg(corner(), walk()), perspective = perspective_svg(corner(), walk());
    EXPECT_THAT(above, HasSubstr(">0.5 m</text>"));
    EXPECT_THAT(perspective, HasSubstr(">3 planes in perspective</text>"));
    EXPECT_THAT(perspective, HasSubstr(">0.5 m</text>"));
    PlaneMap unknown = corner();
    unknown.up.setZero();
    EXPECT_THAT(overhead_svg(unknown, walk()), HasSubstr("up: as the camera was held"));
}

TEST(Drawings, LeaveOutWhatIsNotFinite) {
    PlaneMap map = corner();
    map.planes[0].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    for (const std::string& svg : {overhead_svg(map, walk()), perspective_svg(map, walk())}) {
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("plane 1,")));
        EXPECT_THAT(svg, HasSubstr("plane 3,"));
    }
}

TEST(Drawings, OfAnEmptyMap) {
    for (const std::string& svg : {overhead_svg({}, {}), perspective_svg({}, {}), overhead_svg({}, walk())}) {
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
}

}  // namespace
}  // namespace planemap::map
