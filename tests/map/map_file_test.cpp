// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/scene.hpp"
#include "messages/log.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::map {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MapFile : public ::testing::Test {
  protected:
    void TearDown() override { std::filesystem::remove(file_); }

    /// What reading the file with these bytes complains of; empty if it does not.
    std::string complaint(const std::string& bytes) {
        write_file(file_, bytes);
        try {
            read_plane_map(file_);
            return {};
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), HasSubstr(file_.string()));
            return error.what();
        }
    }

    static PlaneMap map() {
        const scene::Rectangle wall{scene::facing({3, -2, 1}, {0.3, 1, 0.1}, {0, 0, 1}), 1.5, 1, {}};
        PlaneMap map;
        map.utime = 99;
        map.up = {0, 0, 1};
        map.planes = {MapPlane(4, scene::region_of(wall, Pose::Identity(), 0.05), 12)};
        map.planes[0].label = PlaneLabel::kWall;
        return map;
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("planemap_map_file_test_" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(MapFile, ComesBack) {
    write_plane_map(file_, map());
    const PlaneMap back = read_plane_map(file_);
    EXPECT_EQ(back.utime, 99);
    EXPECT_EQ(back.up, map().up);
    ASSERT_EQ(back.planes.size(), 1u);
    EXPECT_EQ(back.planes[0].id, 4);
    EXPECT_EQ(back.planes[0].label, PlaneLabel::kWall);
    const Outline before = map().planes[0].outline.rings(), after = back.planes[0].outline.rings();
    ASSERT_EQ(after.rings.size(), before.rings.size());
    EXPECT_LT((after.rings[0][0] - before.rings[0][0]).norm(), 0.01);
    EXPECT_EQ(plane_map_log(back), plane_map_log(map())) << "the same bytes again";
}

TEST_F(MapFile, OfALogWithOtherThingsTheNewestMapIsRead) {
    PlaneMap newer = map();
    newer.utime = 100;
    messages::LogEvent other;
    other.channel = "SOMETHING";
    other.bytes = {1, 2, 3};
    write_file(file_, plane_map_log(map()) + messages::encode_event(other) + plane_map_log(newer) +
                          messages::encode_event(other));
    EXPECT_EQ(read_plane_map(file_).utime, 100);
}

TEST_F(MapFile, KeepsWhatWasSeenToBeEmptyBesideTheMap) {
    const SeenSpace seen = test::sample_seen_space();
    write_plane_map(file_, map(), seen);
    EXPECT_EQ(read_seen_space(file_), seen);
    EXPECT_EQ(plane_map_log(read_plane_map(file_)), plane_map_log(map())) << "the map is the same";
    write_plane_map(file_, map());
    EXPECT_TRUE(read_seen_space(file_).empty()) << "as of earlier files";
    write_file(file_, plane_map_log(map(), seen) + plane_map_log(map()));
    EXPECT_TRUE(read_seen_space(file_).empty()) << "that was another map's";
}

TEST_F(MapFile, SpoiltSeenSpaceIsRefusedInWordsAndTheMapIsNot) {
    const std::string alone = plane_map_log(map()), both = plane_map_log(map(), test::sample_seen_space());
    ASSERT_EQ(both.substr(0, alone.size()), alone);
    for (std::size_t i = both.size() - 40; i < both.size() - 8; ++i) {  // of the stream
        std::string spoilt = both;
        spoilt[i] = static_cast<char>(spoilt[i] ^ 0x5a);
        EXPECT_EQ(complaint(spoilt), "");
        try {
            read_seen_space(file_);
            ADD_FAILURE() << i;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), AllOf(HasSubstr(file_.string()), HasSubstr("seen space is corrupt")));
        }
    }
}

TEST_F(MapFile, SaysWhatIsWrong) {
    EXPECT_THROW(read_plane_map("/no/such/file"), std::runtime_error);
    const std::string whole = plane_map_log(map());
    EXPECT_EQ(complaint(whole), "");
    EXPECT_THAT(complaint(""), HasSubstr("no map"));
    EXPECT_THAT(complaint("this is no log at all, is it?"), HasSubstr(":"));
    for (std::size_t size = 1; size < whole.size(); size += 7)
        EXPECT_NE(complaint(whole.substr(0, size)), "") << size << " of " << whole.size() << " bytes";
}

TEST_F(MapFile, NeverCrashesOnSpoiltBytes) {
    const std::string whole = plane_map_log(map());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string spoilt = whole;
        spoilt[i] = static_cast<char>(spoilt[i] ^ 0x5a);
        complaint(spoilt);  // a changed coordinate is a map too; anything else must be refused in words
    }
}

}  // namespace
}  // namespace planemap::map
