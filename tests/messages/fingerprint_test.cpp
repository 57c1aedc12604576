// SPDX-License-Identifier: BSD-3-Clause
// The bot_core types must stay wire-compatible with the LCM world: their fingerprints are pinned.
#include <gtest/gtest.h>

#include <bot_core/images_t.hpp>
#include <bot_core/pointcloud_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/raw_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/sensor_status_t.hpp>

namespace {

template <typename T>
std::uint64_t fingerprint() {
    return static_cast<std::uint64_t>(T::getHash());
}

TEST(Fingerprint, BotCoreTypesAreTheEcosystems) {
    EXPECT_EQ(fingerprint<bot_core::image_t>(), 0x14739ffe13d5f5f0u);
    EXPECT_EQ(fingerprint<bot_core::images_t>(), 0x20ba4f05e8f5e33au);
    EXPECT_EQ(fingerprint<bot_core::pose_t>(), 0x2e16efb052b0105eu);
    EXPECT_EQ(fingerprint<bot_core::rigid_transform_t>(), 0xea9ffbf2acc5c5aeu);
    EXPECT_EQ(fingerprint<bot_core::pointcloud_t>(), 0x0d89dc76eb295069u);
    EXPECT_EQ(fingerprint<bot_core::raw_t>(), 0x30571b45b804c18eu);
    EXPECT_EQ(fingerprint<bot_core::sensor_status_t>(), 0x22bd8eb19e834aadu);
}

}  // namespace
