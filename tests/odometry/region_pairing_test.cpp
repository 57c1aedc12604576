// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/region_pairing.hpp"

#include <gmock/gmock.h>

#include <thread>

#include "shell_fixture.hpp"

namespace planemap::odometry {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

class RegionPairingTest : public test::ShellTest {
  protected:
    RegionPairingTest() { publish_camera(); }
    RegionPairing pairing(bool is_in_process) {
        return {status_, is_in_process, [this](const FrameWithRegions& input) {
                    handled_.emplace_back(input.frame->utime(), input.regions.has_value());
                }};
    }
    std::shared_ptr<const messages::Frame> frame_of(std::int64_t utime) {
        bus_.drain();
        return decoder_.decode({messages::channels::kFrame, messages::to_bytes(frame(utime)), utime});
    }
    std::int64_t lost(const char* reason) const {
        const auto found = status_.losses().find(reason);
        return found == status_.losses().end() ? 0 : found->second;
    }

    messages::FrameDecoder decoder_{bus_};
    messages::ModuleStatus status_{"odometry"};
    std::vector<std::pair<std::int64_t, bool>> handled_;  ///< utime of the frame, whether with regions
};

TEST_F(RegionPairingTest, RegionsMayComeBeforeOrAfterTheirFrame) {
    RegionPairing pairing = this->pairing(true);
    pairing.add(frame_of(1));
    EXPECT_TRUE(handled_.empty());
    pairing.add(messages::FrameRegions{1, {}});
    pairing.add(messages::FrameRegions{2, {}});
    pairing.add(frame_of(2));
    EXPECT_THAT(handled_, ElementsAre(Pair(1, true), Pair(2, true)));
    EXPECT_TRUE(status_.losses().empty());
}

TEST_F(RegionPairingTest, RegionsOfALaterFrameSayThatNoneWillComeForThoseBefore) {
    RegionPairing pairing = this->pairing(true);
    for (int utime : {1, 2, 3}) pairing.add(frame_of(utime));
    pairing.add(messages::FrameRegions{2, {}});
    EXPECT_THAT(handled_, ElementsAre(Pair(1, false), Pair(2, true)));
    EXPECT_EQ(lost("frames handled without their regions"), 1);
    pairing.finish();
    EXPECT_THAT(handled_, ElementsAre(Pair(1, false), Pair(2, true), Pair(3, false)));
}

TEST_F(RegionPairingTest, RegionsThatComeLateOrTwiceOrForNoFrameAreCounted) {
    RegionPairing pairing = this->pairing(true);
    pairing.add(frame_of(5));
    pairing.add(messages::FrameRegions{5, {}});
    pairing.add(messages::FrameRegions{5, {}});
    pairing.add(messages::FrameRegions{4, {}});
    pairing.add(messages::FrameRegions{6, {}});
    pairing.add(messages::FrameRegions{6, {}});
    EXPECT_EQ(lost("regions that came late or twice"), 3);
    for (std::size_t i = 0; i < RegionPairing::kMaxWaiting; ++i)
        pairing.add(messages::FrameRegions{100 + static_cast<std::int64_t>(i), {}});
    EXPECT_EQ(lost("regions that no frame waited for"), 1);
    EXPECT_EQ(handled_.size(), 1u);
}

TEST_F(RegionPairingTest, NoMoreThanEightFramesWait) {
    RegionPairing pairing = this->pairing(true);
    constexpr int kFrames = 30;
    for (int i = 1; i <= kFrames; ++i) pairing.add(frame_of(i));
    EXPECT_EQ(handled_.size(), kFrames - RegionPairing::kMaxWaiting) << "in one process they always wait";
    pairing.finish();
    EXPECT_EQ(handled_.size(), static_cast<std::size_t>(kFrames));
}

TEST_F(RegionPairingTest, WithoutASegmentationOnTheBusFramesDoNotWaitUntilRegionsComeAgain) {
    RegionPairing pairing = this->pairing(false);
    for (int i = 1; i <= 30; ++i) pairing.add(frame_of(i));
    EXPECT_EQ(handled_.size(), 30u);
    pairing.add(messages::FrameRegions{31, {}});
    pairing.add(frame_of(31));
    pairing.add(frame_of(32));
    EXPECT_EQ(handled_.back(), (std::pair<std::int64_t, bool>(31, true)));
}

TEST_F(RegionPairingTest, AFrameGoesOnAfterHalfASecondOfQuiet) {
    RegionPairing pairing = this->pairing(false);
    pairing.add(frame_of(1));
    EXPECT_TRUE(pairing.poll());
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    EXPECT_FALSE(pairing.poll());
    EXPECT_THAT(handled_, ElementsAre(Pair(1, false)));
}

}  // namespace
}  // namespace planemap::odometry
