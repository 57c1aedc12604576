// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_output.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/scene.hpp"
#include "map/map_file.hpp"
#include "temporary_folder.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::keyframe;
using scene::Rectangle;

const Rectangle kWall{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}};

/// A map of one wall, and, if they are to be two, of another one that does not hang together with it.
void see_a_wall(ComponentMaps& maps, bool are_two = false) {
    KeyframeTrajectory trajectory;
    trajectory.revision = 1;
    for (const int id : {0, 1, 5}) {
        maps.add(keyframe(id, {kWall}, Pose::Identity()));
        trajectory.keyframes.push_back({id, 1000, Pose::Identity(), are_two && id == 5 ? 5 : 0});
    }
    maps.update(trajectory);
}

class MapOutputTest : public testing::Test {
  protected:
    std::size_t planes(const char* name = "plane_map.lcmlog") const {
        return read_plane_map(folder_ / name).planes.size();
    }
    const test::TemporaryFolder folder_;
    ComponentMaps maps_{MapOptions{}};
};

TEST_F(MapOutputTest, WithoutAFolderNothingIsWritten) {
    MapOutput output({});
    output.open(maps_);
    output.change();
    EXPECT_FALSE(output.poll(maps_));
    EXPECT_FALSE(output.finish(maps_));
    EXPECT_FALSE(output.leaves_earlier());
    EXPECT_EQ(output.error(), "");
}

TEST_F(MapOutputTest, WhatIsNewIsWrittenAndOnlyThat) {
    MapOutput output(folder_.path());
    output.open(maps_);
    EXPECT_EQ(planes(), 0u);
    EXPECT_FALSE(output.finish(maps_)) << "nothing is new";
    see_a_wall(maps_, true);
    output.change();
    EXPECT_FALSE(output.poll(maps_)) << "it was written a moment ago";
    EXPECT_TRUE(output.finish(maps_));
    EXPECT_EQ(planes(), 1u);
    EXPECT_EQ(planes("plane_map_2.lcmlog"), 1u);
    EXPECT_FALSE(output.finish(maps_));
}

TEST_F(MapOutputTest, AnEarlierMapStaysUntilThereAreOtherPlanes) {
    {
        ComponentMaps earlier{MapOptions{}};
        see_a_wall(earlier, true);
        MapOutput output(folder_.path());
        output.open(earlier);
        output.change();
        output.finish(earlier);
    }
    MapOutput output(folder_.path());
    output.open(maps_);
    output.change();
    output.finish(maps_);
    EXPECT_EQ(planes(), 1u);
    EXPECT_TRUE(output.leaves_earlier());
    see_a_wall(maps_);
    output.change();
    output.finish(maps_);
    EXPECT_FALSE(output.leaves_earlier());
    EXPECT_EQ(planes(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "plane_map_2.lcmlog")) << "it was of the earlier map";
    std::size_t kept = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        kept += entry.path().filename().string().starts_with("plane_map.earlier-");
    EXPECT_EQ(kept, 1u);
}

TEST_F(MapOutputTest, APathThatCannotBeAFolderIsAnErrorAtOnce) {
    std::ofstream(folder_ / "file") << "no folder";
    EXPECT_THROW(MapOutput(folder_ / "file").open(maps_), std::exception);
    std::filesystem::create_directories(folder_ / "taken/plane_map.lcmlog");
    EXPECT_THROW(MapOutput(folder_ / "taken").open(maps_), std::runtime_error);
}

}  // namespace
}  // namespace planemap::map
