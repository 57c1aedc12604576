// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_journal.hpp"

#include <spdlog/spdlog.h>

#include <bot_core/images_t.hpp>
#include <exception>
#include <planemap/keyframe_t.hpp>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::octomap {

ScanJournal::Earlier ScanJournal::earlier() {
    for (const std::string& complaint : journal_.complaints()) spdlog::warn("octomap: {}", complaint);
    Earlier earlier;
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus);
    std::shared_ptr<const messages::Frame> frame;
    const auto take = [&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kTrajectory) {
            earlier.trajectory = event.bytes;
        } else if (event.channel == messages::channels::kCameraInfo) {
            bus.publish_bytes(event.channel, event.bytes);
            bus.drain();
        } else if (event.channel == messages::channels::kFrame) {
            frame = decoder.decode({event.channel, event.bytes, event.utime});
        } else if (frame) {
            const auto keyframe = messages::decode<keyframe_t>(event.bytes);
            if (keyframe.utime != frame->utime()) return;
            earlier.scans[keyframe.id] = std::make_shared<StoredScan>(frame->depth(), frame->camera());
            earlier.keyframes.push_back({keyframe.id, keyframe.previous_id, keyframe.utime});
            earlier.newest = event.bytes;
        }
    };
    journal_.replay([&](const messages::LogEvent& event) {
        try {
            take(event);
        } catch (const std::exception& error) {
            bus_.complaints().add(file().string() + ": a keyframe left out: " + error.what());
        }
    });
    return earlier;
}

void ScanJournal::keep(const messages::Frame& frame, std::span<const std::uint8_t> keyframe) {
    if (!camera_ || !(*camera_ == frame.camera())) {
        camera_ = frame.camera();
        journal_.add(messages::channels::kCameraInfo, messages::to_bytes(messages::to_message(
                                                          frame.camera(), frame.utime(), 0, bus_.session())));
    }
    bot_core::images_t images;
    images.utime = frame.utime();
    images.n_images = 1;
    images.image_types.push_back(bot_core::images_t::DEPTH_MM_ZIPPED);
    images.images.push_back(
        messages::depth_image_message(frame.depth(), frame.utime(), messages::DepthEncoding::kZipped));
    journal_.add(messages::channels::kFrame, messages::to_bytes(images));
    journal_.add(messages::channels::kKeyframe, keyframe);
}

void ScanJournal::save_trajectory() {
    if (trajectory_.empty()) return;
    journal_.add(messages::channels::kTrajectory, trajectory_);
    trajectory_.clear();
    saved_us_ = messages::now_us();
}

void ScanJournal::tend(const std::set<int>& named, std::size_t max_keyframes,
                       messages::ModuleStatus& status) {
    constexpr std::int64_t kSavePeriod_us = 1000000;
    if (messages::now_us() - saved_us_ >= kSavePeriod_us) save_trajectory();
    if (journal_.is_due_to_compact() && !named.empty()) {
        save_trajectory();
        compact(named, max_keyframes);
    }
    if (const auto news = journal_.news()) status.remark("journal", *news);
}

void ScanJournal::compact(const std::set<int>& named, std::size_t max_keyframes) {
    std::set<int> kept = named;
    while (kept.size() > max_keyframes) kept.erase(kept.begin());
    const int newest = *named.rbegin();
    std::set<std::int64_t> frames;  // of the keyframes that stay, by utime
    std::int64_t last_trajectory = -1;
    const auto stays = [&](const keyframe_t& keyframe) {
        return keyframe.id > newest || kept.contains(keyframe.id);
    };
    journal_.replay([&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kTrajectory) last_trajectory = event.number;
        if (event.channel != messages::channels::kKeyframe) return;
        const auto keyframe = messages::decode<keyframe_t>(event.bytes);
        if (stays(keyframe)) frames.insert(keyframe.utime);
    });
    journal_.compact([&](const messages::LogEvent& event) {
        if (event.channel == messages::channels::kTrajectory) return event.number == last_trajectory;
        if (event.channel == messages::channels::kCameraInfo) return true;
        if (event.channel == messages::channels::kFrame)
            return frames.contains(messages::decode<bot_core::images_t>(event.bytes).utime);
        return stays(messages::decode<keyframe_t>(event.bytes));
    });
}

}  // namespace planemap::octomap
