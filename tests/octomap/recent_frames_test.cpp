// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/recent_frames.hpp"

#include "shell_fixture.hpp"

namespace planemap::octomap {
namespace {

class RecentFramesTest : public test::ShellTest {
  protected:
    RecentFramesTest() { publish_camera(); }
    std::shared_ptr<const messages::Frame> frame_of(std::int64_t utime) {
        bus_.drain();
        return decoder_.decode({messages::channels::kFrame, messages::to_bytes(frame(utime)), utime});
    }
    messages::FrameDecoder decoder_{bus_};
};

TEST_F(RecentFramesTest, TheLastOnesAreFoundByTheirTime) {
    RecentFrames frames(3);
    EXPECT_EQ(frames.at(1), nullptr);
    for (int utime = 1; utime <= 5; ++utime) frames.add(frame_of(utime));
    EXPECT_EQ(frames.at(2), nullptr);
    for (int utime = 3; utime <= 5; ++utime) {
        ASSERT_NE(frames.at(utime), nullptr);
        EXPECT_EQ(frames.at(utime)->utime(), utime);
    }
}

TEST_F(RecentFramesTest, OfMoreThanSixteenTheirImagesTakeNoMoreThan64MiB) {
    RecentFrames frames(1000);
    const auto one = frame_of(1);
    const std::size_t fit = (64u << 20) / one->image_bytes();
    ASSERT_GT(fit, RecentFrames::kInHandler);
    frames.add(one);
    const auto other = frame_of(2);
    for (std::size_t i = 1; i < fit; ++i) frames.add(other);
    EXPECT_NE(frames.at(1), nullptr);
    frames.add(other);
    EXPECT_EQ(frames.at(1), nullptr);
}

}  // namespace
}  // namespace planemap::octomap
