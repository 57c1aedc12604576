// SPDX-License-Identifier: BSD-3-Clause
// What a connection does in one process; bus_test has its networks and servers.
#include "messages/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap::messages {
namespace {

TEST(Connection, GivesMessagesToThoseWhoseChannelsTheyAreOn) {
    Complaints complaints;
    Connection connection("memq://", complaints);
    std::vector<std::string> one, both;
    connection.subscribe(
        "robot/A", [&](const auto& channel, const auto&) { one.push_back(channel); }, 1);
    connection.subscribe(
        "robot/(A|B)",
        [&](const auto& channel, const auto& buffer) {
            both.push_back(channel + std::to_string(buffer.data_size));
        },
        1);
    for (const char* channel : {"robot/A", "robot/B", "A"})
        connection.send(channel, std::vector<std::uint8_t>(3));
    while (connection.receive(0)) continue;
    EXPECT_THAT(one, testing::ElementsAre("robot/A"));
    EXPECT_THAT(both, testing::ElementsAre("robot/A3", "robot/B3"));
    EXPECT_GE(connection.received(), 2);
    EXPECT_EQ(connection.trouble(), "");
    EXPECT_EQ(complaints.count(), 0);
}

TEST(Connection, WithoutAServerCountsWhatIsSentAndSaysSoOnce) {
    Complaints complaints;
    Connection connection("tcpq://127.0.0.1:1", complaints);
    EXPECT_FALSE(connection.is_up());
    for (int i = 0; i < 3; ++i) connection.send("A", std::vector<std::uint8_t>(1));
    EXPECT_FALSE(connection.receive(1));
    EXPECT_THAT(connection.trouble(), testing::HasSubstr("no connection to tcpq://127.0.0.1:1"));
    EXPECT_THAT(connection.trouble(), testing::HasSubstr("3 messages could not be sent"));
    EXPECT_EQ(complaints.count(), 1);
}

TEST(Connection, AUrlThatCanNeverBeGoodIsAnError) {
    Complaints complaints;
    EXPECT_THROW(Connection("nothing://", complaints), std::runtime_error);
    EXPECT_THROW(Connection("file:///nowhere/at/all.lcmlog", complaints), std::runtime_error);
}

}  // namespace
}  // namespace planemap::messages
