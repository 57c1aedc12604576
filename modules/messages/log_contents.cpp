// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log_contents.hpp"

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <bot_core/pointcloud_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/raw_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/sensor_status_t.hpp>
#include <cstdio>
#include <kinect/frame_msg_t.hpp>
#include <planemap/acceleration_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/look_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/seen_space_t.hpp>
#include <planemap/surfaces_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <vs/object_collection_t.hpp>
#include <vs/point3d_list_collection_t.hpp>

#include "messages/decode.hpp"

namespace planemap::messages {

namespace {

using Names = std::map<std::uint64_t, std::string>;

template <typename... Types>
void add_names(const std::string& package, Names& names) {
    ((names[static_cast<std::uint64_t>(Types::getHash())] = package + "." + Types::getTypeName()), ...);
}

/// A type of ours, also as earlier planemaps wrote it.
template <typename Type>
void add_all_names(Names& names) {
    for (const std::uint64_t known : messages::fingerprints<Type>())
        names[known] = std::string("planemap.") + Type::getTypeName();
}

template <typename... Types>
void add_our_names(Names& names) {
    (add_all_names<Types>(names), ...);
}

}  // namespace

std::string type_name(std::uint64_t fingerprint) {
    static const Names names = [] {
        Names all;
        add_names<bot_core::image_t, bot_core::images_t, bot_core::pointcloud_t, bot_core::pose_t,
                  bot_core::raw_t, bot_core::rigid_transform_t, bot_core::sensor_status_t>("bot_core", all);
        add_names<kinect::frame_msg_t>("kinect", all);
        add_names<vs::object_collection_t, vs::point3d_list_collection_t>("vs", all);
        add_our_names<acceleration_t, camera_info_t, keyframe_t, look_t, map_size_t, module_status_t,
                      odometry_t, planar_regions_t, plane_map_t, earlier_plane_map_t, seen_space_t,
                      surfaces_t, trajectory_t>(all);
        return all;
    }();
    const auto known = names.find(fingerprint);
    if (known != names.end()) return known->second;
    char text[24];
    std::snprintf(text, sizeof(text), "0x%016llx", static_cast<unsigned long long>(fingerprint));
    return text;
}

std::string printable(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return name;
}

void LogContents::add(const LogEvent& event) {
    ++count_;
    const std::pair key(event.channel, messages::fingerprint_of(event.bytes));
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

}  // namespace planemap::messages
