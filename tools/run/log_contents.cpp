// SPDX-License-Identifier: BSD-3-Clause
#include "run/log_contents.hpp"

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <bot_core/pointcloud_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/raw_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/sensor_status_t.hpp>
#include <cstdio>
#include <kinect/frame_msg_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/trajectory_t.hpp>

namespace planemap {

namespace {

template <typename... Types>
std::map<std::uint64_t, std::string> names_of(const char* package) {
    return {
        {static_cast<std::uint64_t>(Types::getHash()), std::string(package) + "." + Types::getTypeName()}...};
}

std::string type_name(std::uint64_t fingerprint) {
    static const std::map<std::uint64_t, std::string> names = [] {
        auto all =
            names_of<bot_core::image_t, bot_core::images_t, bot_core::pointcloud_t, bot_core::pose_t,
                     bot_core::raw_t, bot_core::rigid_transform_t, bot_core::sensor_status_t>("bot_core");
        all.merge(names_of<camera_info_t, keyframe_t, map_size_t, module_status_t, odometry_t,
                           planar_regions_t, plane_map_t, trajectory_t>("planemap"));
        all.merge(names_of<kinect::frame_msg_t>("kinect"));
        return all;
    }();
    const auto known = names.find(fingerprint);
    if (known != names.end()) return known->second;
    char text[24];
    std::snprintf(text, sizeof(text), "0x%016llx", static_cast<unsigned long long>(fingerprint));
    return text;
}

/// A channel's name as it may be printed.
std::string printable(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return name;
}

}  // namespace

std::uint64_t fingerprint(const messages::LogEvent& event) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8 && event.bytes.size() >= 8; ++i) value = value << 8 | event.bytes[i];
    return value;
}

void LogContents::add(const messages::LogEvent& event) {
    ++count_;
    const std::pair key(event.channel, fingerprint(event));
    if (messages_.size() < kMaxRows || messages_.count(key) > 0) {
        ++messages_[key];
    } else {
        ++others_;
    }
}

std::string LogContents::text() const {
    std::string text;
    for (const auto& [key, count] : messages_) {
        text += (text.empty() ? "" : ", ") + printable(key.first) + " " + type_name(key.second) + " (" +
                std::to_string(count) + ")";
    }
    if (others_ > 0) text += " and " + std::to_string(others_) + " messages of other channels or types";
    return text.empty() ? "nothing" : text;
}

}  // namespace planemap
