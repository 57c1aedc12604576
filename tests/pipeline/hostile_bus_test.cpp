// SPDX-License-Identifier: BSD-3-Clause
// Each module on a bus that others spoil: what it is sent twice, late, out of order, stale, oversized or by
// another sender changes nothing of what it says, or costs no more than those messages, and is counted.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <functional>
#include <memory>
#include <numeric>

#include "graph/graph_shell.hpp"
#include "map/map_shell.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/process.hpp"
#include "octomap/octomap_shell.hpp"
#include "odometry/odometry_shell.hpp"
#include "pipeline/pipeline.hpp"
#include "segmentation/segmentation_shell.hpp"
#include "sensor/sensor_shell.hpp"
#include "sensor/source.hpp"

namespace planemap::pipeline {
namespace {

namespace channels = messages::channels;

struct Message {
    std::string channel;
    std::vector<std::uint8_t> bytes;
};
using Stream = std::vector<Message>;

template <typename T>
std::vector<std::uint8_t> encoded(const T& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, message.getEncodedSize());
    return bytes;
}

/// The message as a process of this id sends it; in one process they have none.
Message sent_by(std::int64_t id, Message message) {
    if (message.channel == channels::kFrame) {
        auto images = messages::decode<bot_core::images_t>(message.bytes);
        images.images.back().metadata.erase(images.images.back().metadata.begin() + 1,
                                            images.images.back().metadata.end());
        images.images.back().nmetadata = 1;
        messages::set_sender(images.images.back(), static_cast<std::uint64_t>(id));
        message.bytes = encoded(images);
    } else if (message.channel == channels::kKeyframe) {
        auto keyframe = messages::decode<keyframe_t>(message.bytes);
        keyframe.session = id;
        message.bytes = encoded(keyframe);
    } else if (message.channel == channels::kTrajectory) {
        auto trajectory = messages::decode<trajectory_t>(message.bytes);
        trajectory.session = id;
        message.bytes = encoded(trajectory);
    } else if (message.channel == channels::kSurfaces) {
        auto surfaces = messages::decode<surfaces_t>(message.bytes);
        surfaces.session = id;
        message.bytes = encoded(surfaces);
    }
    return message;
}

/// All that goes over the bus while all modules follow a short walk.
const Stream& walk() {
    static const Stream all = [] {
        messages::Bus bus("memq://");
        Stream stream;
        bus.subscribe(".*", [&stream](const messages::RawMessage& m) {
            stream.push_back(sent_by(7, {std::string(m.channel), {m.bytes.begin(), m.bytes.end()}}));
        });
        PipelineOptions options;
        options.with_octomap = false;
        Pipeline pipeline(bus, options);
        sensor::SensorShellOptions as_fast_as_it_can;
        as_fast_as_it_can.speed = 0;
        sensor::SensorShell sensor(bus, sensor::open_source("sim:office?frames=40&width=320&height=240"),
                                   as_fast_as_it_can);
        while (sensor.poll() >= 0) pipeline.settle();
        pipeline.settle();
        return stream;
    }();
    return all;
}

/// A module with the channels that it hears, and the one that its results are on.
struct Module {
    const char* name;
    std::vector<std::string> hears;
    const char* says;
    std::function<std::unique_ptr<messages::Shell>(messages::Bus&)> make;
};

std::shared_ptr<messages::FrameDecoder> decoder(messages::Bus& bus) {
    return std::make_shared<messages::FrameDecoder>(bus);
}

const std::vector<Module>& modules() {
    static const std::vector<Module> all = {
        {"segmentation",
         {channels::kCameraInfo, channels::kFrame},
         channels::kRegions,
         [](messages::Bus& bus) {
             return std::make_unique<segmentation::SegmentationShell>(bus, decoder(bus),
                                                                      segmentation::SegmentationOptions());
         }},
        {"odometry",
         {channels::kCameraInfo, channels::kFrame, channels::kRegions},
         channels::kOdometry,
         [](messages::Bus& bus) {
             return std::make_unique<odometry::OdometryShell>(bus, decoder(bus), odometry::OdometryOptions());
         }},
        {"graph",
         {channels::kKeyframe, channels::kSurfaces},
         channels::kTrajectory,
         [](messages::Bus& bus) { return std::make_unique<graph::GraphShell>(bus, graph::GraphOptions()); }},
        {"map",
         {channels::kKeyframe, channels::kTrajectory},
         channels::kMap,
         [](messages::Bus& bus) { return std::make_unique<map::MapShell>(bus, map::MapShellOptions()); }},
        {"octomap",
         {channels::kCameraInfo, channels::kFrame, channels::kKeyframe, channels::kTrajectory},
         channels::kOctomapSize,
         [](messages::Bus& bus) {
             return std::make_unique<octomap::OctomapShell>(bus, decoder(bus), octomap::OctomapOptions());
         }}};
    return all;
}

/// What a module made of a stream.
struct Outcome {
    std::vector<std::vector<std::uint8_t>> said;
    std::int64_t counted = 0;  ///< messages that it did not use
    std::string line;
};

Outcome follow(const Module& module, const Stream& stream) {
    messages::Bus bus("memq://");
    const auto shell = module.make(bus);
    Outcome outcome;
    bus.subscribe(module.says, [&](const messages::RawMessage& m) {
        outcome.said.emplace_back(m.bytes.begin(), m.bytes.end());
    });
    for (const Message& message : stream) {
        bus.publish_bytes(message.channel, message.bytes);
        bus.drain();
    }
    shell->finish();
    bus.drain();
    for (const auto& [what, count] : shell->status().losses()) outcome.counted += count;
    outcome.counted += shell->status().decode_error_count();
    outcome.line = shell->status().line();
    return outcome;
}

/// What the module hears of the walk.
Stream heard_by(const Module& module) {
    Stream stream;
    for (const Message& message : walk())
        if (std::find(module.hears.begin(), module.hears.end(), message.channel) != module.hears.end())
            stream.push_back(message);
    return stream;
}

bool is_camera(const Message& message) {
    return message.channel == channels::kCameraInfo;
}

class HostileBus : public testing::TestWithParam<Module> {
  protected:
    void SetUp() override {
        spdlog::set_level(spdlog::level::off);
        clean_ = follow(GetParam(), stream_);
        ASSERT_FALSE(clean_.said.empty());
    }
    void TearDown() override { spdlog::set_level(spdlog::level::info); }

    /// Nothing that the module says changes, and at least so many messages are counted that it did not use.
    void expect_unmoved(const Stream& spoilt, std::int64_t counted) {
        const Outcome outcome = follow(GetParam(), spoilt);
        EXPECT_EQ(outcome.said.size(), clean_.said.size());
        EXPECT_TRUE(outcome.said == clean_.said) << outcome.line;
        EXPECT_GE(outcome.counted - clean_.counted, counted) << outcome.line;
    }

    Stream stream_ = heard_by(GetParam());
    Outcome clean_;
};

TEST_P(HostileBus, EveryMessageTwice) {
    Stream twice;
    std::int64_t extra = 0;
    for (const Message& message : stream_) {
        twice.insert(twice.end(), 2, message);
        // A camera is described again and again, trajectory and surfaces for those who come late: no loss.
        extra += !is_camera(message) && message.channel != channels::kTrajectory &&
                 message.channel != channels::kSurfaces;
    }
    expect_unmoved(twice, extra);
}

TEST_P(HostileBus, StaleMessagesInTheMiddle) {
    const auto middle = stream_.begin() + static_cast<std::ptrdiff_t>(stream_.size() / 2);
    Stream stale(stream_.begin(), middle);
    std::int64_t extra = 0;
    // One after each of the second half: the beginning of the same walk, as a slow route would bring it.
    auto old = stream_.begin();
    for (auto next = middle; next != stream_.end(); ++next, ++old) {
        stale.push_back(*next);
        stale.push_back(*old);
        extra += !is_camera(*old);
    }
    expect_unmoved(stale, extra);
}

TEST_P(HostileBus, TheSecondOfTwoSenders) {
    Stream two;
    std::int64_t extra = 0;
    for (std::size_t i = 0; i < stream_.size(); ++i) {
        two.push_back(stream_[i]);
        // The same walk three messages behind, by another process. Regions do not name their sender: those of
        // another segmentation are of frames that are handled.
        if (i < 3) continue;
        two.push_back(sent_by(8, stream_[i - 3]));
        extra += !is_camera(stream_[i - 3]);
    }
    expect_unmoved(two, extra);
}

TEST_P(HostileBus, OversizedMessages) {
    Stream oversized;
    std::int64_t extra = 0;
    for (const Message& message : stream_) {
        if (extra < 20 && !is_camera(message)) {
            Message garbage = message;  // the right type, then 2 MB of the largest lengths that there are
            garbage.bytes.resize(8);
            garbage.bytes.resize(std::size_t{2} << 20, 0x7f);
            Message longer = message;
            longer.bytes.resize(message.bytes.size() + (std::size_t{2} << 20));
            oversized.push_back(garbage);
            oversized.push_back(longer);
            extra += 2;
        }
        oversized.push_back(message);
    }
    expect_unmoved(oversized, extra);
}

TEST_P(HostileBus, MessagesOutOfOrderAndLateCostNoMoreThanThemselves) {
    Stream shuffled = stream_;
    std::int64_t moved = 0;
    for (std::size_t i = 7; i + 4 < shuffled.size(); i += 10) {
        std::rotate(shuffled.begin() + static_cast<std::ptrdiff_t>(i),
                    shuffled.begin() + static_cast<std::ptrdiff_t>(i + 1),
                    shuffled.begin() + static_cast<std::ptrdiff_t>(i + 4));
        ++moved;
    }
    const Outcome outcome = follow(GetParam(), shuffled);
    EXPECT_GE(static_cast<std::int64_t>(outcome.said.size()) + 2 * moved,
              static_cast<std::int64_t>(clean_.said.size()))
        << outcome.line;
    EXPECT_LE(outcome.said.size(), clean_.said.size()) << outcome.line;
}

INSTANTIATE_TEST_SUITE_P(Modules, HostileBus, testing::ValuesIn(modules()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace planemap::pipeline
