// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap {
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
    EXPECT_THROW(open_source(std::string(10000, 'x')), std::exception);
}

}  // namespace
}  // namespace planemap
