// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/depth_correction.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

TEST(OpenSource, OpensTheSimulator) {
    const auto source = open_source("sim:office?frames=2&width=64&height=48");
    EXPECT_EQ(source->size(), 2u);
    EXPECT_EQ(source->camera().depth.width, 64);
    SensorFrame frame;
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.depth.width, 64);
    EXPECT_EQ(frame.color.height, 48);
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kEnd);
    EXPECT_TRUE(frame.depth.empty());
}

TEST(OpenSource, RefusesWhatItDoesNotKnow) {
    EXPECT_THROW(open_source("sim:moon"), std::invalid_argument);
    EXPECT_THROW(open_source(""), std::runtime_error);
    SourceOptions of_a_camera;
    of_a_camera.duration_s = 3;
    EXPECT_THROW(open_source("sim:office", of_a_camera), std::invalid_argument);
    of_a_camera = {};
    of_a_camera.device.record = "x.oni";
    EXPECT_THROW(open_source("sim:office", of_a_camera), std::invalid_argument);
    EXPECT_THROW(open_source(std::string(10000, 'x')), std::exception);
}

TEST(OpenSource, SomeFramesOfTheSimulator) {
    const std::string name = "sim:office?frames=8&width=80&height=60";
    const auto all = open_source(name), some = open_source(name, {.frames = {3, 6}});
    EXPECT_EQ(some->size(), 3u);
    SensorFrame expected, frame;
    for (int i = 0; i < 8; ++i) {
        all->next(expected);
        if (i < 3 || i >= 6) continue;
        ASSERT_EQ(some->next(frame).status, ReadResult::Status::kFrame);
        EXPECT_EQ(frame.utime, expected.utime);
        EXPECT_EQ(frame.depth.pixels, expected.depth.pixels);
    }
    EXPECT_EQ(some->next(frame).status, ReadResult::Status::kEnd);
    EXPECT_EQ(dynamic_cast<const simulator::SimulatedSource&>(*some).ground_truth().size(), 3u);
    EXPECT_THROW(open_source(name, {.frames = {8, {}}}), std::invalid_argument);
}

TEST(OpenSource, ACorrectionIsDoneBeforeAnybodySeesTheReadings) {
    const std::string name = "sim:office?frames=2&width=80&height=60";
    const auto sensed = open_source(name);
    SourceOptions options;
    options.camera = sensed->camera();
    options.camera->depth_correction.emplace();
    options.camera->depth_correction->offsets.fill(0.01);
    const auto source = open_source(name, options);
    EXPECT_FALSE(source->camera().depth_correction);
    EXPECT_EQ(source->size(), 2u);
    EXPECT_NE(dynamic_cast<const simulator::SimulatedSource*>(&source->origin()), nullptr);
    SensorFrame expected, frame;
    sensed->next(expected);
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    DepthImage corrected = expected.depth;
    correct_depth(corrected, *options.camera);
    EXPECT_NE(corrected.pixels, expected.depth.pixels);
    EXPECT_EQ(frame.depth.pixels, corrected.pixels);
    EXPECT_TRUE(frame.depth_zipped.empty());
}

TEST(OpenSource, TheSimulatorTakesACorrectionAlone) {
    SourceOptions options;
    options.camera = open_source("sim:office?width=80&height=60")->camera();
    EXPECT_THROW(open_source("sim:office?width=80&height=60", options), std::invalid_argument);
    options.camera->depth_correction.emplace();
    EXPECT_NO_THROW(open_source("sim:office?width=80&height=60", options));
    EXPECT_THROW(open_source("sim:office?width=160&height=120", options), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::sensor
