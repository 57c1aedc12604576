// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_journal.hpp"

#include <gmock/gmock.h>

#include "messages/journal.hpp"
#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::octomap {
namespace {

using ::testing::SizeIs;

class ScanJournalTest : public test::ShellTest {
  protected:
    ScanJournalTest() { publish_camera(); }
    void keep(ScanJournal& journal, int id) {
        Keyframe keyframe;
        keyframe.id = id;
        keyframe.previous_id = id - 1;
        keyframe.utime = 1000 * (id + 1);
        bus_.drain();
        const auto decoded = decoder_.decode(
            {messages::channels::kFrame, messages::to_bytes(frame(keyframe.utime)), keyframe.utime});
        journal.keep(*decoded, messages::to_bytes(messages::to_message(keyframe, id)));
    }
    static std::vector<std::uint8_t> trajectory(int keyframes) {
        KeyframeTrajectory trajectory;
        for (int id = 0; id < keyframes; ++id)
            trajectory.keyframes.push_back({id, 1000 * (id + 1), Pose::Identity()});
        return messages::to_bytes(messages::to_message(trajectory, 0));
    }
    messages::FrameDecoder decoder_{bus_};
    messages::ModuleStatus status_{"octomap"};
    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "octomap.journal";
};

TEST_F(ScanJournalTest, AnEmptyOneHasNothing) {
    ScanJournal journal(bus_, file_);
    const ScanJournal::Earlier earlier = journal.earlier();
    EXPECT_TRUE(earlier.scans.empty());
    EXPECT_TRUE(earlier.keyframes.empty());
    EXPECT_TRUE(earlier.trajectory.empty());
}

TEST_F(ScanJournalTest, AnotherProcessHasDepthAndTheLastPoses) {
    {
        ScanJournal journal(bus_, file_);
        for (int id = 0; id < 3; ++id) {
            keep(journal, id);
            journal.hear(trajectory(id + 1));
        }
        journal.save_trajectory();
    }
    ScanJournal journal(bus_, file_);
    const ScanJournal::Earlier earlier = journal.earlier();
    EXPECT_THAT(earlier.scans, SizeIs(3));
    ASSERT_THAT(earlier.keyframes, SizeIs(3));
    EXPECT_EQ(earlier.keyframes.back().id, 2);
    EXPECT_EQ(earlier.keyframes.back().previous_id, 1);
    EXPECT_EQ(earlier.trajectory, trajectory(3));
    EXPECT_EQ(messages::decode<keyframe_t>(earlier.newest).id, 2);
}

TEST_F(ScanJournalTest, AKeyframeThatIsNoneIsLeftOutAndTheOthersStay) {
    {
        ScanJournal journal(bus_, file_);
        for (int id = 0; id < 3; ++id) keep(journal, id);
    }
    int keyframes = 0;
    messages::Journal(file_).compact([&](messages::LogEvent& event) {
        if (event.channel == messages::channels::kKeyframe && ++keyframes == 2) event.bytes.assign(9, 0xff);
        return true;
    });
    ScanJournal journal(bus_, file_);
    EXPECT_THAT(journal.earlier().scans, SizeIs(2));
}

TEST_F(ScanJournalTest, PosesGoToDiskOnceASecond) {
    ScanJournal journal(bus_, file_);
    keep(journal, 0);
    journal.hear(trajectory(1));
    journal.tend({}, 10, status_);
    journal.hear(trajectory(2));
    journal.tend({}, 10, status_);  // within the second: not yet
    EXPECT_EQ(journal.earlier().trajectory, trajectory(1));
    journal.save_trajectory();
    EXPECT_EQ(journal.earlier().trajectory, trajectory(2));
}

}  // namespace
}  // namespace planemap::octomap
