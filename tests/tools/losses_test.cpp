// SPDX-License-Identifier: BSD-3-Clause
// What planemap-run says and does when frames come late, twice, from two senders, or with time going back.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bot_core/images_t.hpp>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/log.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;

class Losses : public testing::Test {
  protected:
    using Change = std::function<void(bot_core::images_t&)>;

    Losses() { std::filesystem::create_directories(folder_); }
    ~Losses() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    int run(const std::string& program, const std::string& arguments) {
        const std::string command = std::string(PLANEMAP_BIN) + "/" + program + " " + arguments + " >'" +
                                    path("out") + "' 2>'" + path("err") + "'";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    /// A simulated walk.
    std::vector<messages::LogEvent> events(const std::string& world) {
        EXPECT_EQ(run("planemap-simulate", "'" + world + "' --output " + path("walk.lcmlog")), 0);
        messages::LogReader log(path("walk.lcmlog"));
        std::vector<messages::LogEvent> all;
        for (messages::LogEvent event; log.next(event);) all.push_back(event);
        return all;
    }
    static std::vector<messages::LogEvent> changed(std::vector<messages::LogEvent> all,
                                                   const Change& change) {
        for (messages::LogEvent& event : all) {
            if (event.channel != messages::channels::kFrame) continue;
            auto images = messages::decode<bot_core::images_t>(event.bytes);
            change(images);
            event.bytes.resize(static_cast<std::size_t>(images.getEncodedSize()));
            images.encode(event.bytes.data(), 0, images.getEncodedSize());
        }
        return all;
    }
    /// Writes and maps a log of the events.
    void map(const std::vector<messages::LogEvent>& events, const std::string& name) {
        messages::LogWriter log(path(name + ".lcmlog"));
        for (const messages::LogEvent& event : events) log.write(event);
        log.close();
        ASSERT_EQ(run("planemap-run", path(name + ".lcmlog") + " --no-octomap -q --output " + path(name)), 0)
            << read_file(path("err"));
        report_ = Json::parse(read_file(folder_ / name / "report.json"));
        out_ = read_file(path("out"));
        err_ = read_file(path("err"));
    }
    int lost(const std::string& what) const {
        return report_.at("losses").value("/odometry"_json_pointer, Json::object()).value(what, 0);
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("planemap_losses_test_" + std::to_string(::getpid()));
    const std::string walk_ = "sim:office?frames=40&width=320&height=240";
    Json report_;
    std::string out_, err_;
};

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t n = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
}

TEST_F(Losses, NothingLostNothingSaid) {
    map(events(walk_), "well");
    EXPECT_TRUE(report_.at("losses").empty()) << report_.at("losses");
    EXPECT_EQ(out_.find("Not used"), std::string::npos);
    EXPECT_TRUE(err_.empty()) << err_;
}

TEST_F(Losses, StampsThatDecreaseAreWarnedOfOnceAndCounted) {
    map(changed(events(walk_), [](auto& images) { images.utime = 100000000 - images.utime; }), "back");
    EXPECT_EQ(lost("frames whose stamp went back"), 39);
    EXPECT_EQ(report_.at("tracked"), 1);
    EXPECT_EQ(count(err_, "a time stamp on OPENNI_FRAME went back by 0.033 s"), 1u) << err_;
    EXPECT_NE(out_.find("39 frames whose stamp went back"), std::string::npos) << out_;
    EXPECT_NE(read_file(folder_ / "back/report.md").find("39 frames whose stamp went back"),
              std::string::npos);
}

TEST_F(Losses, FramesThatComeLateOrTwiceChangeNothing) {
    std::vector<messages::LogEvent> all = events(walk_);
    map(all, "whole");
    const std::string planes = read_file(folder_ / "whole/planes.json");
    all.insert(all.begin() + 20, all[10]);
    all.insert(all.begin() + 25, all[24]);
    map(all, "twice");
    EXPECT_EQ(lost("frames that came late or twice") + lost("frames whose stamp went back"), 2);
    EXPECT_EQ(read_file(folder_ / "twice/planes.json"), planes);
}

TEST_F(Losses, TheSecondOfTwoSendersIsNamedAndChangesNothing) {
    const auto is = [](std::uint64_t id, std::int64_t later) {
        return [id, later](bot_core::images_t& images) {
            images.utime += later;
            if (id != 0) messages::set_sender(images.images.back(), id);
        };
    };
    const std::vector<messages::LogEvent> walk = events(walk_),
                                          other = events("sim:clutter?frames=40&width=320&height=240");
    map(walk, "alone");
    const std::string planes = read_file(folder_ / "alone/planes.json");
    struct Case {
        std::uint64_t first, second;
        std::int64_t later;
        const char* name;
    };
    // With ids; without, an hour earlier, where nothing but the jumps in time tells.
    for (const Case& c : {Case{1, 2, 5000, "ids"}, Case{0, 0, -3600000000, "jumps"}}) {
        const std::vector<messages::LogEvent> first = changed(walk, is(c.first, 0)),
                                              second = changed(other, is(c.second, c.later));
        std::vector<messages::LogEvent> both;
        for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
            both.push_back(first[i]);
            both.push_back(second[i]);
        }
        map(both, c.name);
        EXPECT_GE(lost("frames of another sender"), 38) << c.name;
        const char* said = c.first != 0 ? "another sender on OPENNI_FRAME is ignored"
                                        : "another sender or messages out of order on OPENNI_FRAME: ignored";
        EXPECT_EQ(count(err_, said), 1u) << c.name << ": " << err_;
        EXPECT_EQ(count(err_, "lost 10 frames of another sender so far"), 1u) << "once, not by each module";
        EXPECT_NE(out_.find("frames of another sender (segmentation, odometry)"), std::string::npos) << out_;
        EXPECT_EQ(read_file(folder_ / c.name / "planes.json"), planes) << c.name;
    }
}

/// One frame in fifty, anywhere: what a busy network or sensor leaves out.
std::vector<messages::LogEvent> without_two_percent(const std::vector<messages::LogEvent>& all,
                                                    std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<messages::LogEvent> kept;
    for (const messages::LogEvent& event : all) {
        if (event.channel != messages::channels::kFrame || random() % 50 != 0) kept.push_back(event);
    }
    return kept;
}

TEST_F(Losses, TwoPercentOfTheFramesCostNoAccuracy) {
    const std::string world = "sim:office?frames=300&width=320&height=240";
    const std::vector<messages::LogEvent> all = events(world);
    const auto judged = [&](const std::vector<messages::LogEvent>& some, const std::string& name) {
        map(some, name);
        EXPECT_EQ(run("planemap-evaluate", "'" + world + "' " + path(name) + " --json " + path("json")), 0)
            << read_file(path("err"));
        Json figures = Json::parse(read_file(path("json")));
        figures["tracked"] = report_.at("tracked");
        return figures;
    };
    const Json whole = judged(all, "whole");
    const double ate_m = whole.at("/ate/rmse"_json_pointer);
    const int found = whole.at("/map/found"_json_pointer);
    for (const std::uint32_t seed : {1u, 2u}) {
        const std::vector<messages::LogEvent> some = without_two_percent(all, seed);
        const std::size_t dropped = all.size() - some.size();
        EXPECT_GE(dropped, 3u);
        const Json dented = judged(some, "dented-" + std::to_string(seed));
        EXPECT_EQ(dented.at("tracked"), 300 - dropped) << "no frame beside a gap is lost";
        EXPECT_LT(dented.at("/ate/rmse"_json_pointer), 1.5 * ate_m + 0.002);
        EXPECT_GE(dented.at("/map/found"_json_pointer), found - 1);
        EXPECT_LE(dented.at("/map/spurious"_json_pointer),
                  1 + whole.at("/map/spurious"_json_pointer).get<int>());
    }
}

}  // namespace
}  // namespace planemap
