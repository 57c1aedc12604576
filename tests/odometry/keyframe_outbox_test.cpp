// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_outbox.hpp"

#include <gmock/gmock.h>

#include "messages/journal.hpp"
#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::odometry {
namespace {

using ::testing::SizeIs;

class KeyframeOutboxTest : public test::ShellTest {
  protected:
    static Keyframe keyframe(int id) {
        Keyframe keyframe;
        keyframe.id = id;
        keyframe.previous_id = id - 1;
        keyframe.utime = 1000 * (id + 1);
        return keyframe;
    }
    messages::ModuleStatus status_{"odometry"};
};

TEST_F(KeyframeOutboxTest, CountsItsMessages) {
    KeyframeOutbox outbox(bus_, status_, {});
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    for (int id = 0; id < 3; ++id) outbox.publish(keyframe(id));
    bus_.drain();
    ASSERT_THAT(*keyframes, SizeIs(3));
    EXPECT_EQ(keyframes->back().id, 2);
    EXPECT_EQ(keyframes->back().seq, 2);
    EXPECT_TRUE(outbox.earlier().empty()) << "there is no journal";
}

TEST_F(KeyframeOutboxTest, AnotherProcessKnowsWhatWasPublishedEvenWhereTheJournalIsDamaged) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "odometry.journal";
    {
        KeyframeOutbox outbox(bus_, status_, file);
        for (int id = 0; id < 5; ++id) outbox.publish(keyframe(id));
    }
    messages::Journal(file).compact([](messages::LogEvent& event) {
        if (event.number == 2) event.bytes.assign(40, 0xff);  // a record, but no keyframe
        return true;
    });
    KeyframeOutbox outbox(bus_, status_, file);
    const std::vector<Keyframe> earlier = outbox.earlier();
    ASSERT_THAT(earlier, SizeIs(4));
    EXPECT_EQ(earlier.front().id, 0);
    EXPECT_EQ(earlier.back().id, 4);
}

}  // namespace
}  // namespace planemap::odometry
