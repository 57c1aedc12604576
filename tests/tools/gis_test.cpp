// SPDX-License-Identifier: BSD-3-Clause
// GeoPackages and databases, read back by GDAL's own programs.
#include "export/gis.hpp"

#include <gmock/gmock.h>

#include "exports/corner.hpp"
#include "exports/parts.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class GisTest : public test::Programs {
  protected:
    /// A layer of a file, as ogr2ogr reads it.
    Json layer(const std::string& file, const std::string& name) {
        const Outcome outcome = run_shell("ogr2ogr -f GeoJSON -lco COORDINATE_PRECISION=9 /vsistdout/ '" +
                                          path(file) + "' " + name);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json();
    }
};

/// The corner with values that are not known, an oblique piece of two parts, and a plane that is left out.
PlaneMap a_map() {
    PlaneMap map = scene::corner();
    map.planes[2].rms = std::numeric_limits<float>::quiet_NaN();
    map.inferred.push_back({3, MapOutline(Outline{{scene::rectangle_ring(1, 1, 1.5, 2)}})});
    MapPlane parts = scene::plane_of(20, {scene::facing({0, 0, 3}, {1, 1, 1}, {1, -1, 0}), 1, 1, {}});
    parts.outline =
        MapOutline(Outline{{scene::rectangle_ring(-1, -1, -0.5, 1), scene::rectangle_ring(0.5, -1, 1, 1)}});
    map.planes.push_back(parts);
    map.planes.push_back(scene::plane_of(21, {scene::facing({0, 0, 4}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}}));
    map.planes.back().outline = {};
    return map;
}

TEST_F(GisTest, GdalsProgramsReadTheMap) {
    const PlaneMap map = a_map();
    write_geopackage(folder_ / "planes.gpkg", map, scene::walk());
    const Json planes = layer("planes.gpkg", "planes");
    ASSERT_EQ(planes.at("features").size(), 4u) << "without the plane that has no outline";
    const Eigen::Matrix3d level = exports::upright_frame(map, scene::walk()).level_from_world;
    for (const Json& feature : planes.at("features")) {
        const Json& properties = feature.at("properties");
        const MapPlane& plane = *map.find(properties.at("id").get<int>());
        EXPECT_EQ(properties.at("label"), label_name(plane.label));
        EXPECT_NEAR(properties.at("area").get<double>(), plane.area, 1e-5);
        EXPECT_EQ(properties.at("keyframes"), plane.keyframes);
        EXPECT_EQ(properties.at("rms").is_null(), std::isnan(plane.rms));
        EXPECT_NEAR(properties.at("inferred_area").get<double>(), plane.id == 3 ? 0.5 : 0, 1e-5);
        const Json& geometry = feature.at("geometry");
        EXPECT_EQ(geometry.at("type"), "MultiPolygon");
        EXPECT_EQ(geometry.at("coordinates").size(), plane.id == 20 ? 2u : 1u) << "parts";
        EXPECT_EQ(geometry.at("coordinates")[0].size(), plane.id == 3 ? 2u : 1u) << "a window is a hole";
        for (const Json& polygon : geometry.at("coordinates"))
            for (const Json& ring : polygon) {
                EXPECT_EQ(ring.front(), ring.back());
                for (const Json& p : ring) {
                    ASSERT_EQ(p.size(), 3u);
                    const Eigen::Vector3d p_level(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
                    EXPECT_LT(distance(plane, level.transpose() * p_level), 1e-3);
                }
            }
    }
    const Json lines = layer("planes.gpkg", "lines");
    ASSERT_EQ(lines.at("features").size(), 1u);
    EXPECT_EQ(lines.at("features")[0].at("properties").at("plane_b"), 3);
    EXPECT_NEAR(lines.at("features")[0].at("properties").at("length").get<double>(), 2, 1e-6);
    const Outcome info = run_shell("ogrinfo -ro -so '" + path("planes.gpkg") + "' planes");
    EXPECT_THAT(info.out, HasSubstr("Geometry: 3D Multi Polygon"));
    EXPECT_THAT(info.out, HasSubstr("Undefined Cartesian SRS")) << "no place on Earth";
    EXPECT_THAT(info.out, HasSubstr("R, row by row")) << "how it is turned";
}

TEST_F(GisTest, TheSameMapGivesTheSameBytes) {
    for (const char* file : {"a.gpkg", "b.gpkg", "b.gpkg"}) write_geopackage(folder_ / file, a_map(), {});
    EXPECT_EQ(read_file(folder_ / "a.gpkg"), read_file(folder_ / "b.gpkg"));
    write_geopackage(folder_ / "empty.gpkg", {}, {});
    EXPECT_EQ(layer("empty.gpkg", "planes").at("features").size(), 0u);
}

TEST_F(GisTest, ADatabaseKeepsWhatItHasUnlessToldOtherwise) {
    const std::string database = path("data.gpkg");
    ASSERT_EQ(run_shell("cd $dir && echo '{\"type\":\"Point\",\"coordinates\":[1,2]}' >p.json && ogr2ogr "
                        "data.gpkg p.json -nln other")
                  .exit_code,
              0);
    write_to_database(database, a_map(), {}, false);
    EXPECT_EQ(layer("data.gpkg", "planes").at("features").size(), 4u);
    EXPECT_EQ(layer("data.gpkg", "other").at("features").size(), 1u);
    PlaneMap two = a_map();
    two.planes.resize(2);
    try {
        write_to_database(database, two, {}, false);
        FAIL() << "written over";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("data.gpkg: has a table planes already"));
    }
    EXPECT_EQ(layer("data.gpkg", "planes").at("features").size(), 4u);
    write_to_database(database, two, {}, true);
    EXPECT_EQ(layer("data.gpkg", "planes").at("features").size(), 2u);
    EXPECT_EQ(layer("data.gpkg", "other").at("features").size(), 1u);
}

TEST_F(GisTest, WhatCannotBeWrittenIsOneLine) {
    const auto refusal = [](const auto& write) {
        try {
            write();
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refusal([&] { write_geopackage(folder_ / "no/such.gpkg", a_map(), {}); }),
                HasSubstr("such.gpkg"));
    EXPECT_THAT(refusal([&] { write_to_database(path("none.gpkg"), a_map(), {}, false); }),
                HasSubstr("none.gpkg"));
    write_file(folder_ / "text.gpkg", "no database");
    EXPECT_THAT(refusal([&] { write_to_database(path("text.gpkg"), a_map(), {}, true); }),
                HasSubstr("text.gpkg"));
    const std::string secret =
        refusal([&] { write_to_database("PG:host=127.0.0.1 port=1 password=secret", a_map(), {}, true); });
    EXPECT_THAT(secret, HasSubstr("PG:host=127.0.0.1"));
    EXPECT_THAT(secret, testing::Not(HasSubstr("secret")));
}

}  // namespace
}  // namespace planemap
