// SPDX-License-Identifier: BSD-3-Clause
// The bot_core types must stay wire-compatible with the LCM world: their fingerprints are pinned.
#include <gtest/gtest.h>

#include <bot_core/images_t.hpp>
#include <bot_core/pointcloud_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/raw_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/sensor_status_t.hpp>
#include <vs/object_collection_t.hpp>
#include <vs/point3d_list_collection_t.hpp>

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

// vs types are field by field those of libbot's visualization pod as oh-distro carries it; where the figures
// come from is lcm-gen, fed with that pod's own files.
TEST(Fingerprint, CollectionsAreTheViewers) {
    EXPECT_EQ(fingerprint<vs::object_t>(), 0x6096f52c3949c837u);
    EXPECT_EQ(fingerprint<vs::object_collection_t>(), 0x48dae1018f96f277u);
    EXPECT_EQ(fingerprint<vs::point3d_list_t>(), 0xe31495ad722ccae0u);
    EXPECT_EQ(fingerprint<vs::point3d_list_collection_t>(), 0xf36c375d1c92cb20u);
}

}  // namespace
