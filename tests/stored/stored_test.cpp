// SPDX-License-Identifier: BSD-3-Clause
// Files of an earlier planemap (README.md beside this file says which): each stays readable, or is refused in
// one line that names what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>
#include <map>
#include <numbers>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <set>

#include "core/camera_file.hpp"
#include "core/trajectory_file.hpp"
#include "exports/exports.hpp"
#include "map/map_file.hpp"
#include "map/queries.hpp"
#include "messages/bus.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kAnotherType = ": the fingerprint is another type's";

class Stored : public test::Programs {
  protected:
    static std::string stored(const std::string& name) { return PLANEMAP_SOURCE "/tests/stored/" + name; }

    static std::vector<messages::LogEvent> events() {
        std::vector<messages::LogEvent> all;
        messages::LogReader log(stored("live.lcmlog"));
        for (messages::LogEvent event; log.next(event);) all.push_back(event);
        EXPECT_EQ(log.complaints(), std::vector<std::string>{});
        return all;
    }
    /// The stored log with another fingerprint on these channels: what it will be once their types change.
    std::string log_of_other_types(const std::set<std::string>& channels) {
        messages::LogWriter log(path("other_types.lcmlog"));
        for (messages::LogEvent event : events()) {
            if (channels.contains(event.channel)) event.bytes[0] ^= 0x5a;
            log.write(event);
        }
        log.close();
        return path("other_types.lcmlog");
    }
    /// Replays a log into a module.
    Outcome replay(const std::string& module, const std::string& log) {
        return run("planemap-" + module, (module == "map" ? "--output " + path("map") : "") +
                                             " --lcm-url 'file://" + log + "?speed=0'");
    }
    static std::vector<std::string> lines_with(const std::string& text, const std::string& part) {
        std::vector<std::string> found;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
            if (line.find(part) != std::string::npos) found.push_back(line);
        return found;
    }
    static std::set<int> plane_ids(const Json& planes_json) {
        std::set<int> ids;
        for (const Json& plane : planes_json.at("planes")) ids.insert(plane.at("id").get<int>());
        return ids;
    }
};

/// The first key whose value in `now` is missing or another; empty if there is none. What came to it since is
/// no matter.
std::string first_difference(const Json& then, const Json& now, const std::string& at = "") {
    if (then.is_object() && now.is_object()) {
        for (const auto& [key, value] : then.items()) {
            if (!now.contains(key)) return at + "/" + key + " is gone";
            const std::string found = first_difference(value, now.at(key), at + "/" + key);
            if (!found.empty()) return found;
        }
        return {};
    }
    if (then.is_array() && now.is_array() && then.size() == now.size()) {
        for (std::size_t i = 0; i < then.size(); ++i) {
            const std::string found = first_difference(then[i], now[i], at + "/" + std::to_string(i));
            if (!found.empty()) return found;
        }
        return {};
    }
    if (then.is_number() && now.is_number()) {
        const double a = then.get<double>(), b = now.get<double>();
        if (std::abs(a - b) <= 2e-6 * std::max(1.0, std::abs(a))) return {};
    }
    return then == now ? "" : at + ": " + then.dump() + " is now " + now.dump();
}

TEST_F(Stored, AMapIsReadAskedAndExported) {
    const PlaneMap map = map::read_plane_map(stored("plane_map.lcmlog"));
    ASSERT_EQ(map.planes.size(), 6u);
    EXPECT_EQ(map.planes[0].label, PlaneLabel::kWall);
    EXPECT_EQ(map.planes[4].label, PlaneLabel::kFloor);
    EXPECT_EQ(map.lines.size(), 3u);
    const map::MapQueries queries(map);
    ASSERT_TRUE(queries.nearest({0, 0, 1}));
    const Eigen::Vector3d centre = map.planes[2].center.cast<double>();  // a picture before the wall
    const auto hit = queries.cast(Eigen::Vector3d::Zero(), centre, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->id, 2);
    EXPECT_NEAR(hit->range, centre.norm(), 0.01);
    EXPECT_NEAR(map::relation(map.planes[0], map.planes[4]).angle, std::numbers::pi / 2, 0.02);
    const Trajectory trajectory = read_trajectory_file(stored("trajectory.txt")).poses;
    for (const std::string& file :
         {exports::planes_ply(map, trajectory), exports::planes_obj(map, trajectory),
          exports::planes_glb(map, trajectory), exports::floor_plan_geojson(map, trajectory),
          exports::overhead_svg(map, trajectory), exports::perspective_svg(map, trajectory)})
        EXPECT_GT(file.size(), 1000u);
}

/// Before maps were packed: read without loss, and to 5 mm the same once it is written in today's format.
TEST_F(Stored, AMapOfBeforePackingIsReadAndWrittenPacked) {
    messages::LogReader log(stored("plane_map_unpacked.lcmlog"));
    messages::LogEvent event;
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(messages::fingerprint_of(event.bytes), 0x384b84be8e03e896u);
    const PlaneMap map = map::read_plane_map(stored("plane_map_unpacked.lcmlog"));
    ASSERT_EQ(map.planes.size(), 8u);
    EXPECT_EQ(map.lines.size(), 6u);
    ASSERT_EQ(map.inferred.size(), 1u);
    map::write_plane_map(path("packed.lcmlog"), map);
    EXPECT_LT(2 * std::filesystem::file_size(path("packed.lcmlog")),
              std::filesystem::file_size(stored("plane_map_unpacked.lcmlog")));
    const PlaneMap packed = map::read_plane_map(path("packed.lcmlog"));
    ASSERT_EQ(packed.planes.size(), 8u);
    EXPECT_EQ(packed.lines.size(), 6u);
    for (std::size_t i = 0; i < 8; ++i) {
        const MapPlane &a = map.planes[i], &b = packed.planes[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.label, b.label);
        const Outline before = a.outline.rings(), after = b.outline.rings();
        ASSERT_EQ(before.rings.size(), after.rings.size());
        for (std::size_t r = 0; r < before.rings.size(); ++r) {
            ASSERT_EQ(before.rings[r].size(), after.rings[r].size());
            for (std::size_t k = 0; k < before.rings[r].size(); ++k) {
                const auto at = [&](const MapPlane& plane, const Eigen::Vector2d& v) -> Eigen::Vector3d {
                    return plane.world_from_plane() * Eigen::Vector3d(v.x(), v.y(), 0);
                };
                EXPECT_LE((at(a, before.rings[r][k]) - at(b, after.rings[r][k])).norm(), 0.005);
            }
        }
    }
    map::write_plane_map(path("again.lcmlog"), packed);
    EXPECT_EQ(read_file(path("again.lcmlog")), read_file(path("packed.lcmlog")));
}

TEST_F(Stored, WhatReadsPlanesJsonFindsTheSameKeysAndValues) {
    Json then = Json::parse(read_file(stored("planes.json")));
    const PlaneMap map = map::read_plane_map(stored("plane_map.lcmlog"));
    exports::Sightings sightings;
    for (const Json& plane : then.at("planes"))
        sightings[plane.at("id").get<int>()] = plane.at("keyframes").get<std::vector<int>>();
    EXPECT_EQ(first_difference(then, Json::parse(exports::planes_json(map, sightings))), "");
}

TEST_F(Stored, ATrajectoryIsReadAndCompared) {
    const TrajectoryFile file = read_trajectory_file(stored("trajectory.txt"));
    EXPECT_EQ(file.format, TrajectoryFormat::kTum);
    EXPECT_EQ(file.poses.size(), 20u);
    const Outcome same = run("planemap-evaluate", stored("trajectory.txt") + " " + stored("trajectory.txt") +
                                                      " --json " + path("same.json"));
    EXPECT_EQ(same.exit_code, 0) << same.err;
}

TEST_F(Stored, ACameraFileIsReadWithAllItsKeys) {
    std::vector<std::string> notes;
    const CameraInfo camera = read_camera_file(stored("camera.json"), &notes);
    EXPECT_EQ(notes, std::vector<std::string>{});
    EXPECT_EQ(camera.depth.width, 192);
    EXPECT_EQ(camera.color.fx, 157.5);
    EXPECT_EQ(camera.depth_min_m, 0.5);
    EXPECT_EQ(camera.depth_max_m, 4);
    EXPECT_EQ(camera.serial, "K1");
}

TEST_F(Stored, FramesAreMappedAndAMapIsGoneOnFrom) {
    const Outcome alone = run("planemap-run", stored("live.lcmlog") + " -q --output " + path("alone"));
    ASSERT_EQ(alone.exit_code, 0) << alone.err;
    EXPECT_EQ(report("alone").at("tracked"), 3);
    EXPECT_EQ(report("alone").at("complaints"), Json::array());
    EXPECT_GE(report("alone").at("planes"), 2);

    const Outcome further =
        run("planemap-run", stored("live.lcmlog") + " -q --output " + path("further") + " --map " +
                                stored("plane_map.lcmlog") + " --poses " + stored("trajectory.txt") +
                                " --camera " + stored("camera.json"));
    ASSERT_EQ(further.exit_code, 0) << further.err;
    const std::set<int> now = plane_ids(Json::parse(read_file(folder_ / "further/planes.json")));
    for (const int id : plane_ids(Json::parse(read_file(stored("planes.json")))))
        EXPECT_TRUE(now.contains(id)) << "plane " << id << " lost its id";
}

/// Sends what a log holds on a channel to who decodes the type; each is taken, or one complaint names channel
/// and type.
template <typename T>
void expect_taken_or_refused(const std::string& file, const std::string& channel, bool must_be_taken) {
    SCOPED_TRACE(file + " " + channel);
    messages::Bus bus("memq://");
    int sent = 0, taken = 0;
    bus.subscribe(channel, [&](const messages::RawMessage& message) {
        messages::decode<T>(message.bytes);
        ++taken;
    });
    messages::LogReader log(PLANEMAP_SOURCE "/tests/stored/" + file);
    for (messages::LogEvent event; log.next(event);) {
        if (event.channel != channel) continue;
        bus.publish_bytes(channel, event.bytes);
        ++sent;
    }
    bus.drain();
    EXPECT_GT(sent, 0);
    if (taken == sent) return;
    EXPECT_FALSE(must_be_taken) << "files that users keep hold this type";
    EXPECT_EQ(taken, 0);
    ASSERT_EQ(bus.complaints().totals().size(), 1u);
    EXPECT_THAT(bus.complaints().totals()[0],
                HasSubstr(channel + ": message dropped: " + T::getTypeName() + kAnotherType));
}

TEST_F(Stored, EachMessageOfALogIsDecodedOrRefusedByItsName) {
    expect_taken_or_refused<bot_core::images_t>("live.lcmlog", messages::channels::kFrame, true);
    for (const std::string file : {"live.lcmlog", "messages.lcmlog"}) {
        const bool all = file == "messages.lcmlog";
        expect_taken_or_refused<camera_info_t>(file, messages::channels::kCameraInfo, true);
        expect_taken_or_refused<earlier_plane_map_t>(file, messages::channels::kMap, true);
        expect_taken_or_refused<bot_core::pose_t>(file, messages::channels::kPose, true);
        expect_taken_or_refused<planar_regions_t>(file, messages::channels::kRegions, all);
        expect_taken_or_refused<odometry_t>(file, messages::channels::kOdometry, all);
        expect_taken_or_refused<keyframe_t>(file, messages::channels::kKeyframe, all);
        expect_taken_or_refused<trajectory_t>(file, messages::channels::kTrajectory, all);
        expect_taken_or_refused<map_size_t>(file, messages::channels::kOctomapSize, all);
        for (const char* module : {"SENSOR", "SEGMENTATION", "ODOMETRY", "GRAPH", "MAP", "OCTOMAP"})
            expect_taken_or_refused<module_status_t>(
                file, std::string(messages::channels::kStatusPrefix) + module, all);
    }
}

/// What a message of an earlier planemap lacks is said not to be known.
TEST_F(Stored, WhatAnEarlierMessageLacksIsNotKnown) {
    std::map<std::string, std::vector<std::uint8_t>> bytes;
    messages::LogReader log(stored("messages.lcmlog"));
    for (messages::LogEvent event; log.next(event);) bytes[event.channel] = event.bytes;
    const auto& camera_bytes = bytes[messages::channels::kCameraInfo];
    ASSERT_TRUE(messages::is_a<camera_info_t>(camera_bytes));
    EXPECT_NE(messages::fingerprint_of(camera_bytes), static_cast<std::uint64_t>(camera_info_t::getHash()));
    const auto camera = messages::decode<camera_info_t>(camera_bytes);
    EXPECT_EQ(camera.session, 0);
    EXPECT_EQ(camera.body_from_camera.rotation[0], 1.0);
    EXPECT_EQ(messages::from_message(camera).noise.offset_m, 0.4);
    EXPECT_FALSE(messages::from_message(camera).body_from_camera);
    const auto status = messages::decode<module_status_t>(bytes["PLANEMAP_STATUS_MAP"]);
    EXPECT_EQ(status.module, "map");
    EXPECT_EQ(status.session, 0);
    EXPECT_EQ(status.age_median_ms, -1);
    EXPECT_EQ(status.age_p95_ms, -1);
    EXPECT_EQ(messages::plane_map_from(bytes[messages::channels::kMap]).planes.size(), 3u);
    EXPECT_GT(messages::decode<planar_regions_t>(bytes[messages::channels::kRegions]).n_regions, 2);
    EXPECT_EQ(messages::decode<map_size_t>(bytes[messages::channels::kOctomapSize]).n_keyframes, 1);
}

TEST_F(Stored, ACameraThatWasDescribedBeforeDistortionHasNone) {
    messages::LogReader log(stored("camera_info.lcmlog"));
    messages::LogEvent event;
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(messages::fingerprint_of(event.bytes), 0xa60897c52a8f1405u);
    const CameraInfo camera = messages::from_message(messages::decode<camera_info_t>(event.bytes));
    EXPECT_EQ(camera.serial, "sim:office");
    EXPECT_EQ(camera.depth.width, 192);
    EXPECT_FALSE(camera.registered);
    EXPECT_FALSE(camera.depth_distortion);
    EXPECT_FALSE(camera.color_distortion);
}

TEST_F(Stored, ALogIsReplayedIntoEachModule) {
    const std::map<std::string, std::string> frames = {{"segmentation", "3 in"}, {"odometry", "3 in"}};
    for (const char* module : {"segmentation", "odometry", "graph", "map", "octomap"}) {
        const Outcome outcome = replay(module, stored("live.lcmlog"));
        EXPECT_EQ(outcome.exit_code, 0) << module << "\n" << outcome.err;
        if (const auto in = frames.find(module); in != frames.end()) {
            EXPECT_THAT(outcome.err, HasSubstr(in->second));
        }
        for (const std::string& line : lines_with(outcome.err, "message dropped"))
            EXPECT_THAT(line, HasSubstr(kAnotherType)) << module;
    }
}

TEST_F(Stored, MessagesWhoseTypeChangedAreRefusedInOneLineAndTheModuleGoesOn) {
    const std::string log = log_of_other_types({messages::channels::kKeyframe, messages::channels::kRegions});
    for (const char* module : {"graph", "map", "octomap"}) {
        const Outcome outcome = replay(module, log);
        EXPECT_EQ(outcome.exit_code, 0) << module << "\n" << outcome.err;
        const auto lines = lines_with(outcome.err, messages::channels::kKeyframe);
        ASSERT_EQ(lines.size(), 1u) << module << "\n" << outcome.err;
        EXPECT_THAT(lines[0], HasSubstr(std::string("keyframe_t") + kAnotherType));
    }
    const Outcome odometry = replay("odometry", log);
    EXPECT_EQ(odometry.exit_code, 0) << odometry.err;
    const auto lines = lines_with(odometry.err, messages::channels::kRegions);
    ASSERT_EQ(lines.size(), 1u) << odometry.err;
    EXPECT_THAT(lines[0], HasSubstr(std::string("planar_regions_t") + kAnotherType));
    EXPECT_THAT(odometry.err, HasSubstr("3 in")) << "the frames are taken all the same";
}

TEST_F(Stored, FilesOfAnotherTypeAreRefusedInOneLineThatNamesIt) {
    const std::string log = log_of_other_types({messages::channels::kFrame, messages::channels::kMap});
    expect_error("planemap-run", log + " --output " + path("out"), messages::channels::kFrame);
    expect_error("planemap-run", stored("live.lcmlog") + " --output " + path("out") + " --map " + log,
                 std::string("plane_map_t") + kAnotherType);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

/// Options that went meanwhile are refused by name, one after the other; with the others the run is as asked.
TEST_F(Stored, OptionsAreTakenOrRefusedByName) {
    std::string options = read_file(stored("planemap-run.conf"));
    const auto run_with_options = [&] {
        write_file(folder_ / "options.conf", options);
        return run("planemap-run", stored("live.lcmlog") + " -q --no-octomap --output " + path("out") +
                                       " --config " + path("options.conf"));
    };
    Outcome outcome = run_with_options();
    for (int gone = 0; gone < 50 && outcome.exit_code != 0; ++gone) {
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        const std::string before = ": unknown option ";
        const std::size_t at = outcome.err.find(before);
        ASSERT_NE(at, std::string::npos) << outcome.err;
        const std::size_t name = at + before.size();
        const std::string line =
            outcome.err.substr(name, outcome.err.find_first_of(" ,", name) - name) + " =";
        const std::size_t found = options.find("\n" + line);
        ASSERT_NE(found, std::string::npos) << line << "\n" << outcome.err;
        options.erase(found, options.find('\n', found + 1) - found);
        outcome = run_with_options();
    }
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(report("out").at("tracked"), 3);

    options += "option-of-the-past = 3\n";
    const Outcome refused = run_with_options();
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("options.conf"));
    EXPECT_THAT(refused.err, HasSubstr("option-of-the-past"));
}

TEST_F(Stored, FilesStaySmall) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(stored("")))
        if (entry.path().extension() != ".cpp") bytes += entry.file_size();
    EXPECT_LT(bytes, 120'000u) << "what is stored is in every clone";
}

}  // namespace
}  // namespace planemap
