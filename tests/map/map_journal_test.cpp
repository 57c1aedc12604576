// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "map/stored_keyframe.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/sample_messages.hpp"
#include "temporary_folder.hpp"

namespace planemap::map {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class MapJournals : public testing::Test {
  protected:
    static std::vector<std::uint8_t> keyframe(int id) {
        Keyframe keyframe = test::sample_keyframe();
        keyframe.id = id;
        return messages::to_bytes(messages::to_message(keyframe, id, 7));
    }
    static std::vector<std::uint8_t> look(int keyframe_id, int number) {
        Look look;
        look.keyframe_id = keyframe_id;
        look.number = number;
        return messages::to_bytes(messages::to_message(look, 0, 7));
    }
    static std::vector<std::uint8_t> surfaces(int id) {
        Surfaces surfaces;
        surfaces.keyframes.push_back({.id = 1, .planes = {id}});
        return messages::to_bytes(messages::to_message(surfaces, 0, 7));
    }
    MapJournal::Earlier replay(MapJournal& journal) {
        keyframes_.clear();
        looks_.clear();
        return journal.replay(
            complaints_, [&](const keyframe_t& k) { keyframes_.push_back(k.id); },
            [&](const look_t& l) { looks_.emplace_back(l.keyframe_id, l.number); });
    }
    std::filesystem::path file() const { return folder_ / "state/map.journal"; }

    TemporaryFolder folder_;
    messages::Complaints complaints_;
    std::vector<int> keyframes_;
    std::vector<std::pair<int, int>> looks_;
};

TEST_F(MapJournals, GiveTheNextProcessWhatCameAndTheLastPosesAndIds) {
    const std::vector<std::uint8_t> poses{1, 2, 3}, later{4, 5};
    {
        MapJournal journal(file());
        const MapJournal::Earlier nothing = replay(journal);
        EXPECT_FALSE(nothing.newest);
        EXPECT_THAT(nothing.trajectory, IsEmpty());
        journal.add(messages::channels::kKeyframe, keyframe(3));
        journal.save([]() -> std::vector<std::uint8_t> { throw std::logic_error("no poses came"); });
        journal.keep_poses(poses);
        journal.save([] { return surfaces(1); });
        journal.add(messages::channels::kKeyframe, keyframe(4));
        journal.add(messages::channels::kLook, look(3, 0));
        journal.keep_poses(later);
        journal.save([] { return surfaces(2); });
    }
    MapJournal journal(file());
    const MapJournal::Earlier earlier = replay(journal);
    EXPECT_THAT(keyframes_, ElementsAre(3, 4));
    EXPECT_THAT(looks_, ElementsAre(std::pair(3, 0)));
    EXPECT_EQ(earlier.trajectory, later);
    ASSERT_THAT(earlier.surfaces.keyframes, SizeIs(1));
    EXPECT_THAT(earlier.surfaces.keyframes[0].planes, ElementsAre(2));
    ASSERT_TRUE(earlier.newest);
    EXPECT_EQ(earlier.newest->id, 4);
    EXPECT_EQ(earlier.newest_bytes, keyframe(4));
    EXPECT_EQ(complaints_.count(), 0);
}

TEST_F(MapJournals, BecomeAsSmallAsTheMapWhateverIsDamagedInThem) {
    {
        MapJournal journal(file());
        journal.add(messages::channels::kKeyframe, std::vector<std::uint8_t>(16, 0x7f));
        journal.add(messages::channels::kLook, std::vector<std::uint8_t>(3, 1));
        const std::size_t bytes = keyframe(0).size();
        const int count = static_cast<int>((std::size_t{5} << 20) / bytes) + 1;
        for (int id = 0; id < count; ++id) journal.add(messages::channels::kKeyframe, keyframe(id));
        const auto kept = static_cast<int>(StoredKeyframe::kMostLater);
        for (int number = 0; number < kept + 5; ++number)
            journal.add(messages::channels::kLook, look(1, number));
        journal.add(messages::channels::kLook, look(9, 0));
        journal.keep_poses(std::vector<std::uint8_t>{1});
        journal.save([] { return surfaces(1); });
        journal.keep_poses(std::vector<std::uint8_t>{2});
        journal.tend([] { return surfaces(2); }, [](int id) { return id == 1 || id == 2; });
        EXPECT_LT(std::filesystem::file_size(file()), std::uintmax_t{1} << 20);
    }
    MapJournal journal(file());
    const MapJournal::Earlier earlier = replay(journal);
    EXPECT_THAT(keyframes_, ElementsAre(1, 2));
    EXPECT_THAT(looks_, SizeIs(StoredKeyframe::kMostLater + 1)) << "the first, and the last ones";
    EXPECT_EQ(earlier.trajectory, std::vector<std::uint8_t>{2});
    ASSERT_THAT(earlier.surfaces.keyframes, SizeIs(1));
    EXPECT_THAT(earlier.surfaces.keyframes[0].planes, ElementsAre(2));
    EXPECT_EQ(complaints_.count(), 0) << "what was damaged is gone";
}

TEST_F(MapJournals, LeaveOutWhatIsDamagedAndSayIt) {
    {
        MapJournal journal(file());
        journal.add(messages::channels::kKeyframe, std::vector<std::uint8_t>(16, 0x7f));
        journal.add(messages::channels::kKeyframe, keyframe(1));
    }
    MapJournal journal(file());
    replay(journal);
    EXPECT_THAT(keyframes_, ElementsAre(1));
    EXPECT_EQ(complaints_.count(), 1);
}

}  // namespace
}  // namespace planemap::map
