// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <numbers>
#include <thread>

#include "core/files.hpp"
#include "map/map_file.hpp"
#include "messages/journal.hpp"
#include "messages/log.hpp"
#include "messages/sample_messages.hpp"
#include "messages/session.hpp"
#include "messages/told_status.hpp"
#include "shell_fixture.hpp"

namespace planemap::map {
namespace {

class MapShellTest : public test::ShellTest {
  protected:
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("planemap_map_shell_test_" + std::to_string(::getpid()));

    static KeyframeTrajectory trajectory() {
        KeyframeTrajectory trajectory;
        trajectory.keyframes = {{3, 1234567, Pose::Identity()}};
        trajectory.utime = 1234567;
        return trajectory;
    }
};

TEST_F(MapShellTest, PublishesTheMapAmongCorruptMessagesAndWritesItAsALog) {
    MapShellOptions options;
    options.output = folder_;
    MapShell shell(bus_, options);
    const auto maps = collect<plane_map_t>(messages::channels::kMap);
    const Keyframe keyframe = test::sample_keyframe();
    publish_corrupt(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    publish_corrupt(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.drain();
    shell.finish();
    ASSERT_EQ(maps->size(), 1u);
    const PlaneMap map = messages::from_message(maps->back());
    EXPECT_EQ(map.planes.size(), 2u);  // two walls a metre apart
    EXPECT_EQ(shell.status().decode_error_count(), 2 * kCorrupt);

    messages::LogReader log(folder_ / "plane_map.lcmlog");
    messages::LogEvent event;
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(event.channel, messages::channels::kMap);
    EXPECT_EQ(messages::from_message(messages::decode<plane_map_t>(event.bytes)).planes.size(), 2u);
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(event.channel, messages::channels::kSeenSpace);
    EXPECT_GT(messages::from_message(messages::decode<seen_space_t>(event.bytes)).volume(), 0);
    EXPECT_FALSE(log.next(event));
}

TEST_F(MapShellTest, HearsWhichWayIsUp) {
    MapShell shell(bus_, {});
    CameraInfo camera = test::sample_camera();
    camera.body_from_camera = Pose(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
    const auto maps = collect<plane_map_t>(messages::channels::kMap);
    publish_corrupt(messages::channels::kAcceleration, messages::to_message(Acceleration{5, {0, -9.8, 0}}));
    bus_.publish(messages::channels::kCameraInfo, messages::to_message(camera, 5, 0));
    bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.drain();
    const PlaneMap map = messages::from_message(maps->back());
    EXPECT_LT((map.up - Eigen::Vector3f(0, 0, -1)).norm(), 0.1f);
    EXPECT_EQ(shell.mapper().why_up().find("by camera.json's body_from_camera"), 0u)
        << shell.mapper().why_up();
    // The accelerometer goes before it.
    Keyframe next = test::sample_keyframe();
    next.id = 4;
    next.utime += 1000000;
    KeyframeTrajectory both = trajectory();
    both.keyframes.push_back({4, next.utime, Pose::Identity()});
    bus_.publish(messages::channels::kAcceleration,
                 messages::to_message(Acceleration{next.utime - 1000, {0, -9.8, 0}}));
    bus_.publish(messages::channels::kKeyframe, messages::to_message(next, 1));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(both, 1));
    bus_.drain();
    EXPECT_EQ(shell.mapper().why_up().find("by the accelerometer"), 0u) << shell.mapper().why_up();
}

TEST_F(MapShellTest, StartsFromAMapAndKeepsAnEarlierOneUntilItHasOne) {
    MapShellOptions options;
    options.output = folder_;
    {
        MapShell shell(bus_, options);
        bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
        bus_.drain();
        shell.finish();
    }
    const std::filesystem::path file = folder_ / "plane_map.lcmlog";
    const std::string map = read_file(file);
    {
        MapShell idle(bus_, options);
        idle.finish();
    }
    EXPECT_EQ(read_file(file), map) << "nothing came, so the earlier map stays";
    options.start = file;
    MapShell shell(bus_, options);
    EXPECT_EQ(shell.mapper().map().planes.size(), 2u);
    EXPECT_FALSE(shell.mapper().map().lines.size() > 0);
    write_file(file, map.substr(0, map.size() - 5));
    EXPECT_THROW(MapShell(bus_, options), std::runtime_error);
    EXPECT_EQ(shell.mapper().map().planes.size(), 2u);
}

TEST_F(MapShellTest, AnEarlierMapIsKeptAndAnEmptyOneDoesNotReplaceIt) {
    MapShellOptions options;
    options.output = folder_;
    const std::filesystem::path file = folder_ / "plane_map.lcmlog";
    std::filesystem::create_directories(folder_);
    PlaneMap earlier = [&] {
        messages::Bus bus("memq://");
        MapShell shell(bus, {});
        bus.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
        bus.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
        bus.drain();
        return shell.mapper().map();
    }();
    earlier.utime = 42;
    write_plane_map(file, earlier);
    const auto kept = [&] {
        std::vector<std::filesystem::path> found;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            if (entry.path() != file) found.push_back(entry.path());
        return found;
    };
    MapShell shell(bus_, options);
    bus_.publish(messages::channels::kTrajectory,
                 messages::to_message(trajectory(), 1));  // a map without planes
    bus_.drain();
    shell.finish();
    EXPECT_EQ(read_plane_map(file).utime, 42);
    EXPECT_TRUE(kept().empty());

    bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 2));
    bus_.drain();
    for (int i = 0; i < 2; ++i) shell.finish();
    EXPECT_NE(read_plane_map(file).utime, 42);
    ASSERT_EQ(kept().size(), 1u);
    EXPECT_EQ(read_plane_map(kept()[0]).utime, 42);
    EXPECT_TRUE(kept()[0].filename().string().starts_with("plane_map.earlier-"));
}

/// The limit on a file's size stands for a full disk: the write fails in the middle.
class FullDisk {
  public:
    FullDisk() {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit full = {16, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &full);
    }
    ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

  private:
    rlimit before_ = {};
};

TEST_F(MapShellTest, AFullDiskOrALostFolderEndsNothingAndTheMapIsWrittenWhenItCanBe) {
    MapShellOptions options;
    options.output = folder_;
    const std::filesystem::path file = folder_ / "plane_map.lcmlog";
    MapShell shell(bus_, options);
    const auto maps = collect<plane_map_t>(messages::channels::kMap);
    const std::string empty = read_file(file);
    bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    {
        const FullDisk full;
        bus_.drain();
        EXPECT_THROW(shell.finish(), std::runtime_error);  // poll() would write in a few seconds only
        EXPECT_EQ(read_file(file), empty) << "half a map never bears the name";
        shell.status().publish_if_due(bus_, 1);
        EXPECT_NE(shell.status().line().find("2 planes; not written, trying every second: " + file.string()),
                  std::string::npos)
            << shell.status().line();
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "nothing is left beside";
    std::filesystem::remove_all(folder_);
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    shell.poll();
    EXPECT_EQ(read_plane_map(file).planes.size(), 2u);
    EXPECT_EQ(shell.status().line().find("not written"), std::string::npos) << shell.status().line();
    EXPECT_NO_THROW(shell.finish());
    EXPECT_EQ(maps->size(), 1u);
}

TEST_F(MapShellTest, ADiskThatIsFullAtTheStartIsOutlived) {
    MapShellOptions options;
    options.output = folder_;
    const std::filesystem::path file = folder_ / "plane_map.lcmlog";
    std::unique_ptr<MapShell> shell;
    {
        const FullDisk full;
        ASSERT_NO_THROW(shell = std::make_unique<MapShell>(bus_, options));
        shell->status().publish_if_due(bus_, 1);
        EXPECT_NE(shell->status().line().find("not written, trying every second: " + file.string()),
                  std::string::npos)
            << shell->status().line();
        EXPECT_THROW(shell->finish(), std::runtime_error);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    shell->poll();
    EXPECT_TRUE(read_plane_map(file).planes.empty());
    EXPECT_NO_THROW(shell->finish());
}

TEST_F(MapShellTest, TheLastMapIsRepeatedAndARepeatedTrajectoryIsNoWork) {
    MapShell shell(bus_, {});
    bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.drain();
    const auto late = collect<plane_map_t>(messages::channels::kMap);
    for (int i = 0; i < 3; ++i)
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.drain();
    EXPECT_TRUE(late->empty());
    EXPECT_EQ(shell.status().work_ms().count(), 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (int i = 0; i < 3; ++i) shell.poll();
    bus_.drain();
    ASSERT_EQ(late->size(), 1u);
    EXPECT_EQ(late->back().seq, 0) << "the same message, not a new one";
    EXPECT_EQ(messages::from_message(late->back()).planes.size(), 2u);
}

TEST_F(MapShellTest, AMapThatWasStartedAgainSaysWhatItLacks) {
    MapShell shell(bus_, {});
    KeyframeTrajectory all = trajectory();
    all.keyframes.insert(all.keyframes.begin(), {{0, 1000, Pose::Identity()}, {2, 2000, Pose::Identity()}});
    bus_.publish(messages::channels::kKeyframe, messages::to_message(test::sample_keyframe(), 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(all, 0));
    bus_.drain();
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    shell.poll();
    EXPECT_NE(shell.status().line().find(
                  "2 keyframes of the trajectory were never received: the map is incomplete"),
              std::string::npos)
        << shell.status().line();
}

TEST_F(MapShellTest, AnotherOdometrysKeyframeWithAKnownIdIsNotUsed) {
    MapShell shell(bus_, {});
    Keyframe keyframe = test::sample_keyframe();
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0));
    bus_.drain();
    ASSERT_EQ(shell.mapper().map().planes.size(), 2u);
    keyframe.utime += 5000000;
    keyframe.regions.clear();
    keyframe.features.clear();
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 1));
    bus_.drain();
    EXPECT_EQ(shell.mapper().map().planes.size(), 2u);
    EXPECT_EQ(shell.status().losses().at("keyframes of another odometry, with an id that is taken"), 1);
}

TEST_F(MapShellTest, WhatItLeavesOutIsCounted) {
    MapShell shell(bus_, {});
    Keyframe keyframe = test::sample_keyframe();
    keyframe.regions[0].box.half_extents.x() = 300;  // nobody sees that far
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    keyframe.id = 2147483647;
    keyframe.utime += 1000000;
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 1));
    KeyframeTrajectory far = trajectory();
    far.keyframes[0].world_from_camera.translation().x() = 2e5;
    bus_.publish(messages::channels::kTrajectory, messages::to_message(far, 0));
    bus_.drain();
    const auto& losses = shell.status().losses();
    EXPECT_EQ(losses.at("regions that are none, or larger or farther than can be seen"), 1);
    EXPECT_EQ(losses.at("keyframes with an id out of order"), 1);
    EXPECT_EQ(losses.at("keyframe poses that are none or out of range"), 1);
    EXPECT_EQ(losses.size(), 3u);
    EXPECT_EQ(test::told(shell.status()).dropped, 1);
}

TEST_F(MapShellTest, AnOutputThatCannotBeWrittenIsAnErrorAtOnce) {
    write_file(folder_.string() + ".file", "x");
    MapShellOptions options;
    options.output = folder_.string() + ".file";
    EXPECT_THROW(MapShell(bus_, options), std::exception);
    std::filesystem::remove(options.output);
    options.output = "/proc/nowhere";
    EXPECT_THROW(MapShell(bus_, options), std::exception);
    options.output = "/proc";
    EXPECT_THROW(MapShell(bus_, options), std::exception);
    options.output = folder_;
    std::filesystem::create_directories(folder_ / "plane_map.lcmlog");
    EXPECT_THROW(MapShell(bus_, options), std::exception);
}

/// As after a SIGKILL: nothing is told to finish.
TEST_F(MapShellTest, OfAJournalWhatIsDamagedOrOfEarlierPlanemapsIsLeftOutAndSaid) {
    MapShellOptions options;
    options.journal = folder_ / "state/map.journal";
    {
        messages::Journal journal(options.journal);
        const auto bytes = [](const auto& message) { return messages::to_bytes(message); };
        journal.add(messages::channels::kKeyframe,
                    bytes(messages::to_message(test::sample_keyframe(), 0, 7)));
        journal.add(messages::channels::kTrajectory, bytes(messages::to_message(trajectory(), 0, 8)));
        journal.add("PLANEMAP_REGION_PLANES", std::vector<std::uint8_t>(16, 0));
        journal.add(messages::channels::kSurfaces, std::vector<std::uint8_t>(16, 0x7f));
    }
    MapShell shell(bus_, options);
    EXPECT_EQ(shell.mapper().map().planes.size(), 2u);
    EXPECT_EQ(bus_.complaints().count(), 2);
}

TEST_F(MapShellTest, AProcessThatIsStartedAgainGoesOnWithItsMapAndDoublesNothing) {
    MapShellOptions options;
    options.journal = folder_ / "state/map.journal";
    const Keyframe keyframe = test::sample_keyframe();
    PlaneMap before;
    {
        messages::Bus bus("memq://");
        MapShell killed(bus, options);
        bus.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0, 7));
        bus.publish(messages::channels::kTrajectory, messages::to_message(trajectory(), 0, 8));
        bus.drain();
        killed.poll();
        before = killed.mapper().map();
        ASSERT_EQ(before.planes.size(), 2u);
    }
    const auto maps = collect<plane_map_t>(messages::channels::kMap);
    MapShell shell(bus_, options);
    bus_.drain();
    ASSERT_EQ(maps->size(), 1u) << "said at once";
    const PlaneMap after = messages::from_message(maps->back());
    ASSERT_EQ(after.planes.size(), before.planes.size());
    for (std::size_t i = 0; i < before.planes.size(); ++i) {
        EXPECT_EQ(after.planes[i].id, before.planes[i].id);
        EXPECT_LT((after.planes[i].center - before.planes[i].center).norm(), 0.005f);
        EXPECT_EQ(shell.mapper().map().planes[i].inliers, before.planes[i].inliers);
        EXPECT_EQ(shell.mapper().map().planes[i].center, before.planes[i].center);
    }
    bus_.publish(messages::channels::kKeyframe,
                 messages::to_message(keyframe, 0, 7));  // odometry sends it again
    bus_.drain();
    EXPECT_EQ(shell.mapper().map().planes[0].inliers, before.planes[0].inliers);
    EXPECT_EQ(test::told(shell.status()).dropped, 0);
    // Odometry was started again, too, and is followed at once.
    Keyframe next = keyframe;
    next.id += 101;
    next.utime += 1000000;
    KeyframeTrajectory both = trajectory();
    both.keyframes.push_back({next.id, next.utime, Pose::Identity()});
    bus_.publish(messages::channels::kKeyframe, messages::to_message(next, 0, messages::next_session(7)));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(both, 0, messages::next_session(8)));
    bus_.drain();
    EXPECT_GT(shell.mapper().map().planes[0].inliers, before.planes[0].inliers);
    const std::map<std::string, std::int64_t> twice{{"keyframes that came twice", 1}};
    EXPECT_EQ(shell.status().losses(), twice);
}

}  // namespace
}  // namespace planemap::map
