// SPDX-License-Identifier: BSD-3-Clause
// planemap-log as a user runs it, on logs that are whole, damaged, hostile, and none.
#include <gmock/gmock.h>

#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/image_codec.hpp"
#include "messages/log.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct LogToolTest : test::Programs {
    /// 20 poses on POSE at 10 Hz with a gap of a second in the middle, one message of a stranger, and
    /// 5 of another channel; 26 events.
    std::string write_log(const std::string& name) {
        messages::LogWriter log(path(name));
        std::int64_t number = 0;
        for (int i = 0; i < 20; ++i) {
            const std::int64_t utime = 1600000000000000 + 100000 * i + (i >= 10 ? 1000000 : 0);
            if (i == 5) log.write({number++, utime, "STRANGE", {1, 2, 3, 4, 5, 6, 7, 8, 9}});
            bot_core::pose_t pose{};
            pose.utime = utime;
            messages::LogEvent event{
                number++, utime, "POSE",
                std::vector<std::uint8_t>(static_cast<std::size_t>(pose.getEncodedSize()))};
            pose.encode(event.bytes.data(), 0, pose.getEncodedSize());
            log.write(event);
            if (i % 4 == 0) {
                event.channel = "OTHER_POSE";
                event.number = number++;
                log.write(event);
            }
        }
        log.close();
        return path(name);
    }
    std::string damaged(const std::string& name) {
        std::string bytes = read_file(write_log(name));
        bytes.replace(1000, 300, std::string(300, '\x55'));
        write_file(path(name), bytes);
        return path(name);
    }
    static std::vector<messages::LogEvent> events(const std::string& file) {
        messages::LogReader reader(file);
        std::vector<messages::LogEvent> all;
        for (messages::LogEvent event; reader.next(event);) all.push_back(event);
        EXPECT_TRUE(reader.complaints().empty()) << file;
        return all;
    }
};

TEST_F(LogToolTest, InfoTellsChannelsTypesRatesAndGaps) {
    const Outcome text = run("planemap-log", "info " + write_log("a.lcmlog"));
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("26 events, 2.900 s from 20200913-122640 UTC"),
                                HasSubstr("POSE        bot_core.pose_t"), HasSubstr("0x0102030405060708")));
    const Json json = Json::parse(run("planemap-log", "info --json " + path("a.lcmlog")).out).at(0);
    EXPECT_EQ(json.at("events"), 26);
    EXPECT_EQ(json.at("channels").size(), 3u);
    const Json& pose = json.at("channels").at(1);
    EXPECT_EQ(pose.at("channel"), "POSE");
    EXPECT_EQ(pose.at("events"), 20);
    EXPECT_EQ(pose.at("gaps"), 1);
    EXPECT_NEAR(pose.at("longest_step_s").get<double>(), 1.1, 1e-6);
    EXPECT_NEAR(pose.at("rate_hz").get<double>(), 19 / 2.9, 1e-6);
}

TEST_F(LogToolTest, CheckTellsDamageByItsPlace) {
    const Outcome whole = run("planemap-log", "check " + write_log("a.lcmlog"));
    EXPECT_EQ(whole.exit_code, 0) << whole.out;
    EXPECT_THAT(whole.out, HasSubstr("26 events, all whole"));
    const Outcome broken = run("planemap-log", "check " + path("a.lcmlog") + " " + damaged("b.lcmlog"));
    EXPECT_EQ(broken.exit_code, 1);
    EXPECT_THAT(broken.out, AllOf(HasSubstr("a.lcmlog: 26 events, all whole"), HasSubstr("b.lcmlog: bytes "),
                                  HasSubstr("events lost"), HasSubstr("whole events, and damage")));
}

TEST_F(LogToolTest, CheckDecodesWhatItKnows) {
    messages::LogWriter log(path("a.lcmlog"));
    std::vector<std::uint8_t> bytes(20, 1);
    const auto fingerprint = static_cast<std::uint64_t>(bot_core::pose_t::getHash());
    for (int i = 0; i < 8; ++i)
        bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(fingerprint >> (56 - 8 * i));
    log.write({0, 0, "POSE", bytes});
    log.write({1, 0, "SHORT", {1}});
    log.close();
    const Outcome outcome = run("planemap-log", "check " + path("a.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("event 0 on POSE, which ends at byte 52: pose_t: pose needs"),
                                   HasSubstr("event 1 on SHORT"), HasSubstr("not even a fingerprint")));
}

TEST_F(LogToolTest, CheckDecodesImages) {
    bot_core::images_t images{};
    images.utime = 1;
    images.n_images = 1;
    images.image_types = {bot_core::images_t::DEPTH_MM_ZIPPED};
    images.images.resize(1);
    bot_core::image_t& depth = images.images[0];
    depth.width = 64;
    depth.height = 48;
    depth.data = messages::encode_zipped_depth(DepthImage(64, 48, 1500), 1);
    depth.size = static_cast<std::int32_t>(depth.data.size());
    messages::LogWriter log(path("a.lcmlog"));
    log.write({0, 0, "OPENNI_FRAME", messages::to_bytes(images)});
    depth.data[depth.data.size() / 2] ^= 0xff;
    log.write({1, 1, "OPENNI_FRAME", messages::to_bytes(images)});
    depth.width = depth.height = 32767;
    log.write({2, 2, "OPENNI_FRAME", messages::to_bytes(images)});
    log.close();
    const Outcome outcome = run("planemap-log", "check " + path("a.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("event 1 on OPENNI_FRAME"), HasSubstr("zipped depth"), HasSubstr("event 2"),
                      HasSubstr("no camera's"), Not(HasSubstr("event 0"))));
}

TEST_F(LogToolTest, CutTakesTimeAndChannels) {
    const std::string log = write_log("a.lcmlog");
    const Outcome outcome = run(
        "planemap-log", "cut " + log + " --from 0.35 --to 2 --channels 'POSE|NO.*' -o " + path("cut.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("cut.lcmlog: 6 events, 20 not selected"));
    const auto all = events(path("cut.lcmlog"));
    ASSERT_EQ(all.size(), 6u);
    EXPECT_EQ(all.front().utime, 1600000000400000);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].number, static_cast<std::int64_t>(i));
    expect_error("planemap-log", "cut " + log + " -o " + path("cut.lcmlog"), "cut.lcmlog: is there already");
    expect_error("planemap-log", "cut " + log + " -o " + log, "a.lcmlog: is there already");
    expect_error("planemap-log", "cut " + log + " --channels NONE -o " + path("x"), "none of its 26 events");
    expect_error("planemap-log", "cut " + log + " --channels '(' -o " + path("x"), "channels");
    expect_error("planemap-log", "cut " + log + " --from -1 -o " + path("x"), "from");
    EXPECT_FALSE(std::filesystem::exists(path("x")));
}

TEST_F(LogToolTest, RepairKeepsEveryWholeEvent) {
    const std::string log = damaged("b.lcmlog"), before = read_file(log);
    const Outcome outcome = run("planemap-log", "repair " + log + " -o " + path("whole.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("bytes left out that are no whole events"));
    EXPECT_THAT(outcome.err, HasSubstr("events lost"));
    EXPECT_EQ(read_file(log), before) << "the source stays as it is";
    EXPECT_GE(events(path("whole.lcmlog")).size(), 22u);
    EXPECT_EQ(run("planemap-log", "check " + path("whole.lcmlog")).exit_code, 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".part")));
    // LCM's own tools read it.
    const Outcome copy =
        run_shell("lcm-logplayer -s 0 -l \"file://$dir/copy.lcmlog?mode=w\" $dir/whole.lcmlog");
    EXPECT_EQ(copy.exit_code, 0) << copy.err;
    EXPECT_EQ(events(path("copy.lcmlog")).size(), events(path("whole.lcmlog")).size());
}

TEST_F(LogToolTest, WhatIsNoLogIsOneLine) {
    write_file(path("empty.lcmlog"), "");
    write_file(path("text.lcmlog"), std::string(10000, 'x'));
    write_file(path("huge.lcmlog"), std::string("\xED\xA1\xDA\x01", 4) + std::string(16, '\0') +
                                        std::string("\0\0\0\x01\x7f\xff\xff\xff", 8) + "A");
    for (const std::string& command : std::vector<std::string>{
             "info ", "check ", "cut -o " + path("new") + " ", "repair -o " + path("new") + " "}) {
        for (const char* name : {"empty.lcmlog", "text.lcmlog", "huge.lcmlog"})
            expect_error("planemap-log", command + path(name), std::string(name) + ": ");
        expect_error("planemap-log", command + folder_.string(), folder_.string());
        expect_error("planemap-log", command + path("none.lcmlog"), "none.lcmlog");
    }
    EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST_F(LogToolTest, StrayBytesAndACutEndAreLeftOut) {
    const std::string whole = read_file(write_log("a.lcmlog"));
    write_file(path("c.lcmlog"), "stray" + whole.substr(0, whole.size() - 10));
    const Outcome outcome = run("planemap-log", "repair " + path("c.lcmlog") + " -o " + path("d.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(events(path("d.lcmlog")).size(), 25u);
}

TEST_F(LogToolTest, WrongCommandsAreOneLine) {
    expect_error("planemap-log", "mend a", "\"mend\" is no command");
    expect_error("planemap-log", "info", "FILE");
    expect_error("planemap-log", "repair a b -o c", "takes one FILE, not 2");
    expect_error("planemap-log", "repair a", "--output is missing");
    expect_error("planemap-log", "info a -o c", "takes no --output");
    expect_error("planemap-log", "check a --from 3", "takes no --from");
}

}  // namespace
}  // namespace planemap
