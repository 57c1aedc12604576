// SPDX-License-Identifier: BSD-3-Clause
#include "messages/bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/interrupt.hpp"
#include "messages/log.hpp"
#include "messages/module_status.hpp"
#include "messages/sample_messages.hpp"
#include "messages/tcpq_server.hpp"

namespace planemap::messages {
namespace {

/// The messages that the bus says it could not send.
std::int64_t unsent(const Bus& bus) {
    const std::string trouble = bus.trouble();
    const std::size_t at = trouble.find(" messages could not be sent");
    if (at == std::string::npos) return 0;
    const std::size_t before = trouble.substr(0, at).rfind(' ');
    return std::stoll(trouble.substr(before == std::string::npos ? 0 : before + 1));
}

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
    EXPECT_EQ(bus.complaints().count(), 3);
}

TEST(Bus, AMessageThatSeveralHandlersDropIsOneComplaint) {
    Bus bus("memq://");
    for (int i = 0; i < 3; ++i)
        bus.subscribe("ODO", [](const RawMessage& m) { decode<odometry_t>(m.bytes); });
    for (int i = 0; i < 5; ++i) bus.publish_bytes("ODO", std::vector<std::uint8_t>(40, 0xff));
    bus.drain();
    EXPECT_EQ(bus.complaints().count(), 5);
    ASSERT_EQ(bus.complaints().totals().size(), 1u);
    EXPECT_NE(bus.complaints().totals()[0].find("(5 times)"), std::string::npos);
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

TEST(Bus, EachHasASessionButInOneProcess) {
    const std::string url = "udpm://239.255.76.67:7667?ttl=0";
    const Bus one(url), other(url), alone("memq://");
    EXPECT_NE(one.session(), 0);
    EXPECT_NE(one.session(), other.session());
    EXPECT_EQ(alone.session(), 0);
}

TEST(Bus, UdpmGetsAReceiveBuffer) {
    EXPECT_NE(Bus("udpm://239.255.76.67:7667?ttl=0").url().find("&recv_buf_size=4194304"), std::string::npos);
}

/// What no network can ever make good ends at once, in one line that names the URL.
TEST(Bus, AMalformedUrlIsAnErrorAtOnce) {
    for (const char* url : {"nonsense://x",
                            "udpm",
                            "udpm:/239.255.76.67:7667",
                            "udpm://127.0.0.1:7667",
                            "udpm://host:7667",
                            "udpm://239.255.76.67:port",
                            "udpm://239.255.76.67:0",
                            "udpm://239.255.76.67:70000",
                            "udpm://239.255.76.67:7667?ttl=far",
                            "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=-1",
                            "mpudpm://1.2.3.4",
                            "tcpq://127.0.0.1:",
                            "tcpq://127.0.0.1:seven",
                            "tcpq://a b:7700",
                            "tcpq://127.0.0.1:7700:1",
                            "file://",
                            "file:///no/such/log",
                            "file:///tmp",
                            "file:///tmp/x?mode=q",
                            "udpm://239.255.76.67:7667?tll=1",
                            "udpm://239.255.76.67:7667?ttl",
                            "udpm://239.255.76.67:7667?ttl=0&ttl=1",
                            "udpm://239.255.76.67:7667?ttl=",
                            "tcpq://127.0.0.1:7700?ttl=1",
                            "memq://?ttl=1",
                            "file:///tmp/x?mode=w&sped=2"}) {
        const auto start = std::chrono::steady_clock::now();
        try {
            Bus bus(url);
            ADD_FAILURE() << url;
        } catch (const std::runtime_error& error) {
            const std::string what = error.what(),
                              path = std::string(url).substr(std::string(url).find(':') + 3);
            const bool named = what.find(url) != std::string::npos || what.rfind(path, 0) == 0;
            EXPECT_TRUE(named) << url << ": " << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        }
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1)) << url;
    }
}

TEST(Bus, AnUnknownOptionOfAUrlNamesTheKnownOnes) {
    try {
        Bus bus("udpm://239.255.76.67:7667?tll=1");
        ADD_FAILURE() << "taken";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("'tll' is not an option of udpm; they are recv_buf_size, ttl"));
    }
}

/// Handles until the condition holds, or for some seconds.
template <typename Condition>
bool handle_until(std::initializer_list<Bus*> buses, Condition condition, double seconds = 5) {
    const auto start = std::chrono::steady_clock::now();
    while (!condition()) {
        if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(seconds)) return false;
        for (Bus* bus : buses) bus->handle(20);
    }
    return true;
}

std::uint16_t free_port() {
    return test::TcpqServer().port();
}

TEST(Bus, AServerThatComesLateIsFoundAndOneThatGoesAndComesAgainToo) {
    const std::uint16_t port = free_port();
    const std::string url =
        "tcpq://localhost:" + std::to_string(port);  // a name, which liblcm cannot resolve
    Bus from(url), to(url);
    std::vector<std::size_t> seen;
    to.subscribe("A", [&](const RawMessage& m) { seen.push_back(m.bytes.size()); });
    EXPECT_FALSE(from.connected());
    EXPECT_NE(from.trouble().find("no connection to " + url), std::string::npos) << from.trouble();
    std::size_t size = 0;
    const auto send = [&] { from.publish_bytes("A", std::vector<std::uint8_t>(++size)); };
    send();  // into nothing
    EXPECT_EQ(unsent(from), 1);
    EXPECT_FALSE(handle_until(
        {&from, &to}, [&] { return from.connected(); }, 1.3));
    EXPECT_EQ(from.complaints().totals().size(), 1u) << "said once";

    for (int life = 0; life < 3; ++life) {
        {
            test::TcpqServer server(port);
            ASSERT_TRUE(handle_until({&from, &to}, [&] { return from.connected() && to.connected(); }))
                << life;
            ASSERT_TRUE(handle_until({&from, &to}, [&] { return server.subscriptions() > 0; })) << life;
            const std::size_t before = seen.size();
            send();
            send();
            ASSERT_TRUE(handle_until({&to}, [&] { return seen.size() == before + 2; })) << life;
            EXPECT_EQ(seen.back(), size);
        }
        ASSERT_TRUE(handle_until({&from, &to}, [&] { return !from.connected() && !to.connected(); })) << life;
        const std::int64_t before = unsent(from);
        send();
        EXPECT_EQ(unsent(from), before + 1);
    }
    EXPECT_NE(from.trouble().find("4 messages could not be sent"), std::string::npos) << from.trouble();
}

TEST(Bus, TwoPrefixesOnOneBusDoNotMix) {
    const test::TcpqServer server;
    Bus left(server.url(), "left/"), right(server.url(), "R_"), plain(server.url()), all(server.url());
    std::vector<std::string> at_left, at_right, at_plain, at_all;
    const auto hear = [](Bus& bus, const std::string& channels, std::vector<std::string>& heard) {
        bus.subscribe(channels, [&heard](const RawMessage& m) { heard.emplace_back(m.channel); });
    };
    hear(left, channels::kFrame, at_left);
    hear(right, "OPENNI_FRAME|POSE_BODY", at_right);
    hear(plain, "OPENNI_FRAME|POSE_BODY", at_plain);
    hear(all, ".*", at_all);
    ASSERT_TRUE(handle_until({&left, &right, &plain, &all}, [&] { return server.subscriptions() == 4; }));
    const std::vector<std::uint8_t> bytes(4);
    left.publish_bytes(channels::kFrame, bytes);
    right.publish_bytes(channels::kPose, bytes);
    right.publish_bytes(channels::kFrame, bytes);
    plain.publish_bytes(channels::kPose, bytes);
    ASSERT_TRUE(handle_until({&left, &right, &plain, &all}, [&] { return at_all.size() == 4; }));
    while (left.handle(20) || right.handle(20) || plain.handle(20)) {
    }
    using testing::ElementsAre;
    using testing::UnorderedElementsAre;
    EXPECT_THAT(at_left, ElementsAre(channels::kFrame)) << "handlers see names without the prefix";
    EXPECT_THAT(at_right, ElementsAre(channels::kPose, channels::kFrame));
    EXPECT_THAT(at_plain, ElementsAre(channels::kPose));
    EXPECT_THAT(at_all,
                UnorderedElementsAre("left/OPENNI_FRAME", "R_POSE_BODY", "R_OPENNI_FRAME", "POSE_BODY"));
}

TEST(Bus, APrefixLeavesRoomForEveryChannel) {
    const std::string longest(channels::kMaxChannelPrefix, 'P');
    Bus bus("memq://", longest);
    for (const char* channel :
         {channels::kFrame, channels::kCameraInfo, channels::kRegions, channels::kOdometry, channels::kPose,
          channels::kKeyframe, channels::kTrajectory, channels::kMap, channels::kOctomapSize,
          "PLANEMAP_STATUS_SEGMENTATION"})
        bus.publish_bytes(channel, std::vector<std::uint8_t>(4));
    EXPECT_EQ(unsent(bus), 0);
    EXPECT_THROW(bus.publish_bytes(std::string(33, 'C'), std::vector<std::uint8_t>(4)),
                 std::invalid_argument);
    for (const std::string& bad : {longest + "P", std::string("robot.*"), std::string("two words")}) {
        try {
            Bus refused("memq://", bad);
            FAIL() << bad;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find("channel prefix '" + bad + "'"), std::string::npos);
        }
    }
}

TEST(Bus, AServerThatVanishesWhileASenderDoesNotListenIsNoticed) {
    auto server = std::make_unique<test::TcpqServer>();
    Bus bus(server->url());
    ASSERT_TRUE(bus.connected());
    server.reset();
    for (int i = 0; i < 100 && bus.connected(); ++i) {
        bus.publish_bytes("A", std::vector<std::uint8_t>(100));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(bus.connected());
    EXPECT_GT(unsent(bus), 0);
    EXPECT_FALSE(bus.handle(0));
}

/// A server that hangs is noticed without being asked, and found again when it goes on.
TEST(Bus, AServerThatHangsIsLeftAndFoundAgain) {
    test::TcpqServer server;
    Bus bus(server.url());
    ASSERT_TRUE(bus.connected());
    server.take_no_more();
    const auto start = std::chrono::steady_clock::now();
    int sent = 0;
    for (; sent < 100 && bus.connected(); ++sent) bus.publish_bytes("A", std::vector<std::uint8_t>(1 << 20));
    EXPECT_FALSE(bus.connected());
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(6));
    EXPECT_NE(bus.trouble().find("the server hangs"), std::string::npos) << bus.trouble();
    bus.publish_bytes("A", std::vector<std::uint8_t>(1));
    EXPECT_EQ(unsent(bus), 2) << "of " << sent;
    bus.handle(1000);
    bus.handle(1000);
    EXPECT_NE(bus.trouble().find("does not answer as an LCM server"), std::string::npos) << bus.trouble();
    server.go_on();
    EXPECT_TRUE(handle_until({&bus}, [&] { return bus.connected(); }));
    bus.publish_bytes("A", std::vector<std::uint8_t>(1));
    EXPECT_EQ(unsent(bus), 2);
}

/// A server that takes no more holds a sender up, so that nothing is lost, but not for longer than is wanted.
TEST(Bus, WaitingForAServerCanBeInterrupted) {
    test::TcpqServer server;
    Bus bus(server.url());
    ASSERT_TRUE(bus.connected());
    server.take_no_more();
    std::atomic<bool> done{false};
    std::thread interrupter([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        while (!done) {
            interrupt_waiting();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    });
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100 && bus.connected(); ++i)
        bus.publish_bytes("A", std::vector<std::uint8_t>(1 << 20));
    done = true;
    interrupter.join();
    EXPECT_FALSE(bus.connected());
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(Bus, WhoeverListensAndIsNoServerDoesNotHoldABusUp) {
    const test::TcpqServer dumb(0, false);
    const auto start = std::chrono::steady_clock::now();
    Bus bus(dumb.url());
    EXPECT_FALSE(bus.connected());
    EXPECT_NE(bus.trouble().find("does not answer as an LCM server"), std::string::npos) << bus.trouble();
    for (int i = 0; i < 5; ++i) bus.handle(100);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

/// A server whose queue is full drops the request to connect: liblcm alone would wait for minutes.
TEST(Bus, AServerThatDoesNotAnswerDoesNotHoldABusUp) {
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    ASSERT_EQ(::bind(listener, generic, size), 0);
    ASSERT_EQ(::listen(listener, 0), 0);
    ASSERT_EQ(::getsockname(listener, generic, &size), 0);
    std::vector<int> waiting;
    for (int i = 0; i < 8; ++i) {
        waiting.push_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
        ::connect(waiting.back(), generic, size);
    }
    const auto start = std::chrono::steady_clock::now();
    Bus bus("tcpq://127.0.0.1:" + std::to_string(ntohs(address.sin_port)));
    EXPECT_FALSE(bus.connected());
    EXPECT_FALSE(bus.handle(10));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    for (const int fd : waiting) ::close(fd);
    ::close(listener);
}

TEST(Bus, AServerThatCannotBeReachedOrNamedIsNoError) {
    for (const char* url :
         {"tcpq://192.0.2.1:7700", "tcpq://no-such-host.invalid:7700", "tcpq://127.0.0.1:1"}) {
        const auto start = std::chrono::steady_clock::now();
        Bus bus(url);
        bus.subscribe("A", [](const RawMessage&) {});
        EXPECT_FALSE(bus.connected()) << url;
        EXPECT_FALSE(bus.handle(10)) << url;
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1)) << url;
    }
}

TEST(Bus, TheStatusTellsWhatAilsTheBus) {
    Bus bus("tcpq://127.0.0.1:" + std::to_string(free_port()));
    ModuleStatus status("map");
    status.set_text("7 planes");
    status.publish_if_due(bus, 1000000);
    EXPECT_TRUE(status.publish_if_due(bus, 3000000));
    EXPECT_NE(status.line().find("7 planes; no connection to tcpq://127.0.0.1"), std::string::npos)
        << status.line();
    EXPECT_NE(status.line().find(" UTC ("), std::string::npos) << "since when: " << status.line();
    status.received();
    status.published();
    status.publish_if_due(bus, 4000000);
    EXPECT_EQ(status.line().rfind("failing", 0), 0u) << status.line();
    status.received();
    EXPECT_EQ(status.line().rfind("failing", 0), 0u) << status.line();
}

TEST(Bus, ALogThatIsReadToItsEndEndsTheBus) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("planemap_bus_test_" + std::to_string(::getpid()));
    LogWriter writer(file);
    for (int i = 0; i < 5; ++i) writer.write({i, i, "A", {1, 2, 3}});
    writer.close();
    Bus bus("file://" + file.string() + "?speed=0");
    int seen = 0;
    bus.subscribe("A", [&](const RawMessage&) { ++seen; });
    EXPECT_TRUE(handle_until({&bus}, [&] { return bus.ended(); }));
    EXPECT_EQ(seen, 5);
    std::filesystem::remove(file);
}

TEST(Complaints, ThousandsOfAKindAreAFewLinesAndACount) {
    Complaints complaints;
    std::ostringstream said;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(said)));
    for (int i = 0; i < 10000; ++i) complaints.add("frame " + std::to_string(i) + ".png: cannot be read");
    complaints.add("another thing");
    complaints.log_totals();
    spdlog::set_default_logger(before);
    const std::string text = said.str();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5 + 1 + 1) << text;  // the 1st, 10th ... 10000th
    EXPECT_EQ(complaints.count(), 10001);
    const std::vector<std::string> totals = complaints.totals();
    ASSERT_EQ(totals.size(), 2u);
    EXPECT_EQ(totals[0], "another thing");
    EXPECT_EQ(totals[1], "frame 0.png: cannot be read (10000 times)");
}

TEST(Complaints, KindsAreBounded) {
    spdlog::set_level(spdlog::level::off);
    Complaints complaints;
    for (int i = 0; i < 5000; ++i) complaints.add(std::string(static_cast<std::size_t>(i), 'x'));
    spdlog::set_level(spdlog::level::info);
    EXPECT_EQ(complaints.count(), 5000);
    EXPECT_LE(complaints.totals().size(), Complaints::kMaxKinds + 1);
}

TEST(Bus, AdviceNamesTheSysctl) {
    EXPECT_EQ(receive_buffer_advice("memq://"), "");
    EXPECT_NE(receive_buffer_advice("udpm://239.255.76.67:7667?recv_buf_size=2147483000")
                  .find("net.core.rmem_max=2147483000"),
              std::string::npos);
}

}  // namespace
}  // namespace planemap::messages
