// SPDX-License-Identifier: BSD-3-Clause
// planemap-export makes of a stored map what planemap-run made of the map in memory.
#include <gmock/gmock.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstring>
#include <set>
#include <tuple>

#include "core/cloud_point.hpp"
#include "core/id_color.hpp"
#include "exports/corner.hpp"
#include "map/map_file.hpp"
#include "messages/log.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class ExportTest : public test::Programs {
  protected:
    void map_the_office() {
        ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q --no-octomap -o " + path("run")).exit_code,
                  0);
    }
    std::string bytes(const std::string& file) { return read_file(folder_ / file); }
};

/// planes.json without what only a run knows.
Json without_keyframes(const std::string& text) {
    Json json = Json::parse(text);
    for (Json& plane : json.at("planes")) plane.erase("keyframes");
    return json;
}

/// Numbers that may differ: positions by what a map is rounded to when it is stored, inliers by 0.2 %.
std::string first_difference(const Json& a, const Json& b, const std::string& at = "") {
    if (a.is_number() && b.is_number()) {
        const double x = a.get<double>(), y = b.get<double>();
        return std::abs(x - y) <= std::max(0.01, 0.01 * std::abs(x))
                   ? ""
                   : at + ": " + a.dump() + " and " + b.dump();
    }
    if (a.type() != b.type() || a.size() != b.size()) return at + " differs";
    if (a.is_structured()) {
        for (const auto& [key, value] : a.items()) {
            const Json other = a.is_object() ? b.value(key, Json()) : b.at(std::stoul(key));
            const std::string difference = first_difference(value, other, at + "/" + key);
            if (!difference.empty()) return difference;
        }
        return "";
    }
    return a == b ? "" : at + " differs";
}

TEST_F(ExportTest, GivesWhatTheRunGave) {
    map_the_office();
    const Outcome outcome = run("planemap-export", path("run/plane_map.lcmlog") + " -o " + path("out"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const char* file : {"trajectory.txt", "planes.mtl"})
        EXPECT_EQ(bytes("run/" + std::string(file)), bytes("out/" + std::string(file))) << file;
    // The stored map is rounded to 5 mm: what is drawn of it has about the same size and planes.
    for (const char* file :
         {"planes.ply", "planes.obj", "planes.glb", "floor_plan.geojson", "overhead.svg", "map.svg"}) {
        EXPECT_NEAR(static_cast<double>(bytes("run/" + std::string(file)).size()),
                    static_cast<double>(bytes("out/" + std::string(file)).size()),
                    0.02 * static_cast<double>(bytes("run/" + std::string(file)).size()))
            << file;
    }
    EXPECT_EQ(first_difference(without_keyframes(bytes("run/planes.json")),
                               without_keyframes(bytes("out/planes.json"))),
              "");
    EXPECT_TRUE(Json::parse(bytes("out/planes.json")).at("planes").at(0).at("keyframes").is_null());
    const Json of_run = report("run"), exported = report("out");
    EXPECT_EQ(of_run.at("sizes_bytes").at("plane_map_message"),
              exported.at("sizes_bytes").at("plane_map_message"));
    EXPECT_EQ(exported.at("tracked"), of_run.at("tracked"));
    for (const char* key : {"frames", "accuracy_beside_size", "growth"})
        EXPECT_TRUE(exported.at(key).is_null()) << key;
    EXPECT_TRUE(exported.at("coverage").at("within_2cm").is_null());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/points.ply"));
    EXPECT_THAT(outcome.out, HasSubstr("are not known"));
    EXPECT_EQ(run("planemap-report", path("out")).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/.partial"));
}

TEST_F(ExportTest, KeepsWhatIsNotItsOwn) {
    map_the_office();
    const std::string map = path("run/plane_map.lcmlog"), planes = bytes("run/planes.json");
    expect_error("planemap-export", map + " -o " + path("run"), "planes.json: is there");
    EXPECT_EQ(planes, bytes("run/planes.json"));
    ASSERT_EQ(run("planemap-export", map + " --replace -q -o " + path("run")).exit_code, 0);
    EXPECT_NE(planes, bytes("run/planes.json"));

    // As a live session leaves a folder.
    std::filesystem::create_directory(folder_ / "live");
    std::filesystem::copy(folder_ / "run/plane_map.lcmlog", folder_ / "live");
    write_file(folder_ / "live/octomap.bt", "of the same session");  // as far as anyone can tell
    for (int time = 0; time < 2; ++time) {
        const Outcome outcome = run("planemap-export", path("live/plane_map.lcmlog") + " -o " + path("live"));
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("no trajectory"));
        EXPECT_THAT(outcome.err, HasSubstr("octomap.bt: is no OctoMap (.bt)"));
    }
    EXPECT_EQ(bytes("live/octomap.bt"), "of the same session");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "live/trajectory.txt"));
    EXPECT_EQ(bytes("live/planes.json"), bytes("run/planes.json"));
}

TEST_F(ExportTest, OfALiveSessionsFurtherComponentsNothingIsLost) {
    map_the_office();
    const std::filesystem::path live = folder_ / "live";
    std::filesystem::create_directories(live);
    for (const char* name : {"plane_map.lcmlog", "plane_map_2.lcmlog"})
        std::filesystem::copy_file(folder_ / "run/plane_map.lcmlog", live / name);
    for (const char* name : {"trajectory.txt", "trajectory_2.txt"})
        std::filesystem::copy_file(folder_ / "run/trajectory.txt", live / name);
    for (int i = 0; i < 2; ++i) {  // the second time over an earlier export
        const Outcome outcome =
            run("planemap-export", (live / "plane_map.lcmlog").string() + " -o " + live.string());
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(bytes("live/planes_2.json"), bytes("live/planes.json"));
        EXPECT_EQ(bytes("live/plane_map_2.lcmlog"), bytes("run/plane_map.lcmlog"));
        EXPECT_EQ(bytes("live/trajectory_2.txt"), bytes("run/trajectory.txt"));
    }
}

TEST_F(ExportTest, ComparesWithTheOctomapBesideTheMap) {
    ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q -o " + path("run")).exit_code, 0);
    ASSERT_EQ(run("planemap-export", path("run/plane_map.lcmlog") + " -q -o " + path("out")).exit_code, 0);
    const Json of_run = report("run"), exported = report("out");
    for (const char* key : {"octomap_bt", "octomap_bt_zstd", "octomap_bt_memory"})
        EXPECT_EQ(of_run.at("sizes_bytes").at(key), exported.at("sizes_bytes").at(key)) << key;
    EXPECT_TRUE(exported.at("sizes_bytes").at("octomap_working").is_null());
    EXPECT_EQ(of_run.at("octomap").at("resolution_m"), exported.at("octomap").at("resolution_m"));
    for (const char* key : {"leaves_explained", "area_supported"}) {
        EXPECT_NEAR(of_run.at("coverage").at(key).get<double>(),
                    exported.at("coverage").at(key).get<double>(), 0.01)
            << key;
    }
    EXPECT_THAT(bytes("out/report.md"), HasSubstr("Every ratio below is at that coverage"));
}

TEST_F(ExportTest, WritesOnlyTheFormatsThatAreAskedFor) {
    const std::string stored = PLANEMAP_SOURCE "/tests/stored/plane_map.lcmlog";
    const auto files = [&](const std::string& folder) {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder))
            if (entry.path().filename().string().front() != '.') names.insert(entry.path().filename());
        return names;
    };
    const Outcome two = run("planemap-export", stored + " --format obj,svg -o " + path("two"));
    ASSERT_EQ(two.exit_code, 0) << two.err;
    EXPECT_EQ(files("two"), (std::set<std::string>{"planes.obj", "planes.mtl", "overhead.svg", "map.svg"}));
    EXPECT_THAT(two.out, testing::StartsWith("In "));
    // What is not asked for stays, whoever's it is.
    write_file(folder_ / "two/planes.json", "mine");
    ASSERT_EQ(run("planemap-export", stored + " --format ply -q -o " + path("two")).exit_code, 0);
    EXPECT_EQ(bytes("two/planes.json"), "mine");
    EXPECT_EQ(files("two").size(), 6u);
    expect_error("planemap-export", stored + " --format json -o " + path("two"), "planes.json: is there");
    EXPECT_EQ(bytes("two/planes.json"), "mine");
    // All of them together are what is written without --format.
    ASSERT_EQ(run("planemap-export", stored + " -q -o " + path("all")).exit_code, 0);
    ASSERT_EQ(run("planemap-export",
                  stored + " --format map,json,ply,obj,gltf,geojson,svg,report -q -o " + path("each"))
                  .exit_code,
              0);
    EXPECT_EQ(files("all"), files("each"));
    for (const char* file : {"planes.json", "planes.ply", "planes.glb", "floor_plan.geojson", "map.svg"})
        EXPECT_EQ(bytes("all/" + std::string(file)), bytes("each/" + std::string(file))) << file;
}

TEST_F(ExportTest, SaysWhatIsWrongWithFormats) {
    const std::string stored = PLANEMAP_SOURCE "/tests/stored/plane_map.lcmlog", out = " -o " + path("out");
    expect_error("planemap-export", stored, "--output is required");
    expect_error("planemap-export", stored + out + " --format glft",
                 "\"glft\" is no format, did you mean gltf?");
    expect_error("planemap-export", stored + out + " --format ply,,obj", "\"\" is no format");
    expect_error("planemap-export", stored + out + " --format ply,ply", "ply is given twice");
    expect_error("planemap-export", stored + out + " --format cloud-ply", "give --cloud");
    expect_error("planemap-export", stored + out + " --format ply --cloud sim:office", "in vain");
    expect_error("planemap-export", stored + out + " --cloud sim:office --trajectory " + path("none.txt"),
                 "none.txt");
    expect_error("planemap-export", stored + out + " --cloud openni2", "live camera");
    expect_error("planemap-export", stored + out + " --cloud " + path("none.lcmlog"), "none.lcmlog");
    expect_error("planemap-export", stored + out + " --cloud sim:office --cloud-voxel-m 0", "voxel");
    expect_error("planemap-export",
                 stored + out + " --cloud 'sim:office?frames=2' --trajectory " +
                     std::string(PLANEMAP_SOURCE "/tests/fuzz/corpus/trajectory_file/tum.txt"),
                 "has a pose");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/cloud.ply"));
    if (run("planemap-export", stored + out + " --format gpkg").exit_code !=
        0)  // where it was built without GDAL
        expect_error("planemap-export", stored + out + " --format gpkg", "-DPLANEMAP_GDAL=ON");
}

/// The points of a cloud.ply of ours: positions and planes.
struct PlyPoint {
    Eigen::Vector3f position;
    Rgb color;
    int plane;
};
std::vector<PlyPoint> read_ply(const std::string& bytes) {
    const std::string lead = "element vertex ", end = "end_header\n";
    const auto count = std::stoul(bytes.substr(bytes.find(lead) + lead.size()));
    const char* at = bytes.data() + bytes.find(end) + end.size();
    std::vector<PlyPoint> points(count);
    for (PlyPoint& point : points) {
        std::memcpy(point.position.data(), at, 12);
        std::memcpy(&point.color, at + 12, 3);
        std::memcpy(&point.plane, at + 15, 4);
        at += 19;
    }
    EXPECT_EQ(at, bytes.data() + bytes.size());
    return points;
}

TEST_F(ExportTest, ACloudLiesOnThePlanesThatExplainIt) {
    map_the_office();
    const std::string map = path("run/plane_map.lcmlog");
    const auto make = [&](const std::string& folder, const std::string& more) {
        return run("planemap-export", map + " --cloud 'sim:office?frames=20' -q -o " + path(folder) + more);
    };
    const Outcome outcome = make("out", " --format cloud-ply,cloud-pcd");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const std::vector<PlyPoint> points = read_ply(bytes("out/cloud.ply"));
    ASSERT_GT(points.size(), 5000u);
    const PlaneMap office = map::read_plane_map(map);
    const Eigen::Matrix3d level_from_world = scene::said_rotation(bytes("out/cloud.ply"));
    std::size_t explained = 0;
    for (const PlyPoint& point : points) {
        if (point.plane < 0) {
            EXPECT_EQ(point.color, CloudPoint::kNoColor);
            continue;
        }
        ++explained;
        const MapPlane* plane = office.find(point.plane);
        ASSERT_NE(plane, nullptr);
        EXPECT_EQ(point.color, id_color(point.plane));
        const Eigen::Vector3d p_world = level_from_world.transpose() * point.position.cast<double>();
        EXPECT_LT(std::abs(plane->plane().signed_distance(p_world)), 0.15);
        EXPECT_LT(distance(*plane, p_world), 0.2);
    }
    EXPECT_GT(static_cast<double>(explained), 0.6 * static_cast<double>(points.size()));

    // The Point Cloud Library reads the other one, in the world frame.
    pcl::PointCloud<pcl::PointXYZRGBL> cloud;
    ASSERT_EQ(pcl::io::loadPCDFile(path("out/cloud.pcd"), cloud), 0);
    ASSERT_EQ(cloud.size(), points.size());
    for (std::size_t i = 0; i < points.size(); i += 97) {
        const Eigen::Vector3d p = level_from_world * cloud[i].getVector3fMap().cast<double>();
        EXPECT_LT((p - points[i].position.cast<double>()).norm(), 1e-4);
        EXPECT_EQ(static_cast<int>(cloud[i].label), points[i].plane);
        EXPECT_EQ((Rgb{cloud[i].r, cloud[i].g, cloud[i].b}), points[i].color);
    }

    // The same bytes again; of each cube one point; no more than are allowed.
    ASSERT_EQ(make("again", "").exit_code, 0);
    EXPECT_EQ(bytes("again/cloud.pcd"), bytes("out/cloud.pcd"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "again/planes.ply"));
    std::set<std::tuple<int, int, int>> cubes;
    for (const auto& p : cloud)
        cubes.emplace(std::floor(p.x / 0.02), std::floor(p.y / 0.02), std::floor(p.z / 0.02));
    EXPECT_GT(static_cast<double>(cubes.size()), 0.95 * static_cast<double>(cloud.size()))
        << "but for what lies on the edge of two";
    const Outcome few = make("few", " --format cloud-pcd --cloud-most 1000");
    EXPECT_EQ(few.exit_code, 0);
    EXPECT_THAT(few.err, HasSubstr("more than 1000"));
    ASSERT_EQ(pcl::io::loadPCDFile(path("few/cloud.pcd"), cloud), 0);
    EXPECT_LE(cloud.size(), 1000u);
    EXPECT_GT(cloud.size(), 100u);
}

TEST_F(ExportTest, AFrameWithoutAPoseIsNotInTheCloud) {
    map_the_office();
    const std::string map = path("run/plane_map.lcmlog");
    const Outcome outcome = run(
        "planemap-export", map + " --cloud 'sim:office?frames=40' --format cloud-pcd -q -o " + path("out"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("20 of its 40 frames have no pose"));
}

TEST_F(ExportTest, BadInputIsOneLine) {
    const std::string out = " -o " + path("out");
    expect_error("planemap-export", path("none.lcmlog") + out, "none.lcmlog");
    expect_error("planemap-export", path("") + out, "is a folder");
    write_file(folder_ / "text.lcmlog", "a letter, not a log\n");
    expect_error("planemap-export", path("text.lcmlog") + out, "no LCM log");
    messages::LogEvent event{0, 0, "OTHER", {1, 2, 3}};
    write_file(folder_ / "other.lcmlog", messages::encode_event(event));
    expect_error("planemap-export", path("other.lcmlog") + out, "holds no map");
    event = {0, 0, "PLANEMAP_MAP", std::vector<std::uint8_t>(60, 7)};
    write_file(folder_ / "old.lcmlog", messages::encode_event(event));
    expect_error("planemap-export", path("old.lcmlog") + out, "the format of another planemap");
    const std::string whole = map::plane_map_log({});
    write_file(folder_ / "cut.lcmlog", whole.substr(0, whole.size() - 5));
    expect_error("planemap-export", path("cut.lcmlog") + out, "cut short");
    map::write_plane_map(folder_ / "empty.lcmlog", {});
    expect_error("planemap-export", path("empty.lcmlog --trajectory ") + path("none.txt") + out, "none.txt");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    const Outcome empty = run("planemap-export", path("empty.lcmlog") + out);
    EXPECT_EQ(empty.exit_code, 0) << empty.err;
    EXPECT_THAT(empty.err, HasSubstr("has no planes"));
}

}  // namespace
}  // namespace planemap
