// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "virtual_camera/feed.hpp"

namespace planemap::virtual_camera {
namespace {

constexpr const char* kWorld = "sim:office?width=64&height=48&frames=20";

TEST(VirtualCameraOrder, ComesThroughTheEnvironmentAsItWas) {
    Order order{"sim:office?frames=3&seed=2", {}};
    order.options.drop = 0.25;
    order.options.registration = "late";
    order.options.once = true;
    const Order back = read_order(to_text(order));
    EXPECT_EQ(back.input, order.input);
    EXPECT_EQ(to_text(back), to_text(order));
    EXPECT_EQ(back.options.drop, 0.25);
    EXPECT_TRUE(back.options.once);
    EXPECT_THROW(read_order("sim:office\nno_such=1\n"), std::invalid_argument);
    EXPECT_THROW(read_order("sim:office\ndrop=2\n"), std::invalid_argument);
}

TEST(VirtualCameraFeed, TheSameOrderGivesTheSameTicks) {
    Order order{kWorld, {}};
    order.options.drop = order.options.color_drop = 0.3;
    order.options.jitter_ms = 10;
    Feed a(order), b(order);
    Tick tick, same;
    int lost = 0;
    for (int i = 0; i < 50; ++i) {  // more than the input has
        ASSERT_TRUE(a.next(tick) && b.next(same));
        EXPECT_EQ(tick.due_us, same.due_us);
        EXPECT_EQ(tick.depth.pixels, same.depth.pixels);
        EXPECT_EQ(tick.color.pixels, same.color.pixels);
        EXPECT_GE(tick.due_us, tick.depth_us - 1000);
        lost += tick.depth.empty();
    }
    EXPECT_GT(lost, 5);
    EXPECT_LT(lost, 30);
}

TEST(VirtualCameraFeed, ClockAndOffsetAreAsOrdered) {
    Order order{kWorld, {}};
    order.options.color_offset_ms = 8;
    order.options.clock_reset_s = 0.5;
    order.options.once = true;
    Feed feed(order);
    std::int64_t last = 0;
    int ticks = 0, resets = 0;
    for (Tick tick; feed.next(tick); ++ticks) {
        resets += tick.depth_us < last;
        if (tick.color_us > tick.depth_us) {
            EXPECT_EQ(tick.color_us, tick.depth_us + 8000);
        }
        last = tick.depth_us;
    }
    EXPECT_EQ(ticks, 20);
    EXPECT_EQ(resets, 1);
}

TEST(VirtualCameraFeed, DepthIsInMillimetres) {
    Order fine{std::string(kWorld) + "&noise=0&units=5000", {}}, coarse{std::string(kWorld) + "&noise=0", {}};
    Tick a, b;
    ASSERT_TRUE(Feed(fine).next(a) && Feed(coarse).next(b));
    for (std::size_t i = 0; i < a.depth.pixels.size(); ++i)
        EXPECT_NEAR(a.depth.pixels[i], b.depth.pixels[i], 1);
}

}  // namespace
}  // namespace planemap::virtual_camera
