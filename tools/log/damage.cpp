// SPDX-License-Identifier: BSD-3-Clause
#include "log/damage.hpp"

#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>
#include <functional>
#include <kinect/frame_msg_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <stdexcept>

#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_pixels.hpp"
#include "messages/log.hpp"
#include "messages/log_contents.hpp"

namespace planemap {

namespace {

constexpr std::int64_t kMaxLines = 20;

template <typename T>
void decode_if(const messages::LogEvent& event) {
    if (messages::is_a<T>(event.bytes)) messages::decode<T>(event.bytes);
}

template <typename... Types>
void decode_any(const messages::LogEvent& event) {
    (decode_if<Types>(event), ...);
}

/// The pixels of an image; throws where its bytes do not hold them.
void decode_pixels(const bot_core::image_t* image,
                   const std::function<void(const bot_core::image_t&)>& decode) {
    constexpr std::int64_t kMostPixels = 1 << 26;  // before room is made for what a damaged message says
    if (image == nullptr) return;
    if (std::int64_t{image->width} * image->height > kMostPixels)
        throw messages::MessageError("an image of " + std::to_string(image->width) + " x " +
                                     std::to_string(image->height) + " pixels is no camera's");
    decode(*image);
}

/// Messages that pack images or a map, with these.
void decode_contents(const messages::LogEvent& event) {
    if (messages::is_a<plane_map_t>(event.bytes) || messages::is_a<earlier_plane_map_t>(event.bytes))
        messages::plane_map_from(event.bytes);
    if (!messages::is_a<bot_core::images_t>(event.bytes)) return;
    const auto images = messages::decode<bot_core::images_t>(event.bytes);
    const bool zipped = messages::depth_is_zipped(images);
    decode_pixels(messages::find_depth(images),
                  [&](const bot_core::image_t& depth) { messages::depth_pixels(depth, zipped); });
    decode_pixels(messages::find_color(images),
                  [](const bot_core::image_t& color) { messages::luma_pixels(color); });
}

/// Why an event is no message of the type that its fingerprint says; empty if it is, or the type is not ours.
std::string fault_of(const messages::LogEvent& event) {
    if (event.bytes.size() < 8) return std::to_string(event.bytes.size()) + " bytes, not even a fingerprint";
    try {
        decode_any<bot_core::pose_t, kinect::frame_msg_t, camera_info_t, keyframe_t, map_size_t,
                   module_status_t, odometry_t, planar_regions_t, trajectory_t>(event);
        decode_contents(event);
        return {};
    } catch (const messages::MessageError& error) {
        return error.what();
    }
}

}  // namespace

LogDamage find_damage(const std::filesystem::path& file, const std::function<bool(double)>& progress) {
    messages::LogReader log(file);
    LogDamage damage;
    std::vector<std::string> undecodable;
    for (messages::LogEvent event; log.next(event);) {
        ++damage.events;
        const std::string fault = fault_of(event);
        if (!fault.empty() && ++damage.undecodable <= kMaxLines) {
            undecodable.push_back(file.string() + ": event " + std::to_string(event.number) + " on " +
                                  messages::printable(event.channel) + ", which ends at byte " +
                                  std::to_string(log.bytes_read()) + ": " + fault);
        }
        if (!progress(static_cast<double>(log.bytes_read()) / static_cast<double>(log.bytes_total())))
            throw std::runtime_error(file.string() + ": stopped before its end");
    }
    if (damage.events == 0)
        throw std::runtime_error(file.string() + ": is no LCM log: there is not one whole event in it");
    damage.lines = log.complaints();
    damage.lines.insert(damage.lines.end(), undecodable.begin(), undecodable.end());
    if (damage.undecodable > kMaxLines)
        damage.lines.push_back(file.string() + ": and " + std::to_string(damage.undecodable - kMaxLines) +
                               " events more that cannot be decoded");
    return damage;
}

}  // namespace planemap
