// SPDX-License-Identifier: BSD-3-Clause
#include "messages/bus.hpp"

#include <gtest/gtest.h>

#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/sample_messages.hpp"

namespace planemap {
namespace {

TEST(Bus, DeliversInOrderAndDropsNothingOnMemq) {
    Bus bus("memq://");
    std::vector<std::int32_t> seen;
    bus.subscribe(
        "ODO", [&](const RawMessage& m) { seen.push_back(decode<odometry_t>(m.bytes).seq); }, 1);
    for (int i = 0; i < 200; ++i) bus.publish("ODO", to_message(OdometryEstimate(), i));
    bus.drain();
    ASSERT_EQ(seen.size(), 200u);
    for (int i = 0; i < 200; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(Bus, AHandlerThatThrowsIsCountedAndTheNextMessagesArrive) {
    Bus bus("memq://");
    int good = 0;
    bus.subscribe("ODO", [&](const RawMessage& m) {
        decode<odometry_t>(m.bytes);
        ++good;
    });
    const std::vector<std::uint8_t> corrupt(40, 0xff);
    for (int i = 0; i < 3; ++i) {
        bus.publish_bytes("ODO", corrupt);
        bus.publish("ODO", to_message(OdometryEstimate(), i));
    }
    bus.drain();
    EXPECT_EQ(good, 3);
    EXPECT_EQ(bus.handler_errors(), 3);
}

TEST(Bus, MessagesPublishedInAHandlerArrive) {
    Bus bus("memq://");
    int echoes = 0;
    bus.subscribe("A", [&](const RawMessage& m) { bus.publish_bytes("B", m.bytes); });
    bus.subscribe("B", [&](const RawMessage& m) { echoes += m.bytes.size() == 3 ? 1 : 0; });
    const std::vector<std::uint8_t> bytes{1, 2, 3};
    bus.publish_bytes("A", bytes);
    bus.drain();
    EXPECT_EQ(echoes, 1);
}

TEST(Bus, UdpmGetsAReceiveBufferAndABadUrlIsNamed) {
    EXPECT_NE(Bus("udpm://239.255.76.67:7667?ttl=0").url().find("&recv_buf_size=4194304"), std::string::npos);
    try {
        Bus bus("nonsense://x");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("nonsense://x"), std::string::npos);
    }
}

TEST(Bus, AdviceNamesTheSysctl) {
    EXPECT_EQ(receive_buffer_advice("memq://"), "");
    EXPECT_NE(receive_buffer_advice("udpm://239.255.76.67:7667?recv_buf_size=2147483000")
                  .find("net.core.rmem_max=2147483000"),
              std::string::npos);
}

}  // namespace
}  // namespace planemap
