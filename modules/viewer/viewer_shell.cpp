// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_shell.hpp"

#include "core/components.hpp"
#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/image_codec.hpp"
#include "viewer/collections.hpp"
#include "viewer/previews.hpp"

namespace planemap::viewer {

namespace channels = messages::channels;

OptionList options_of(ViewerOptions& options) {
    OptionList list("Viewer");
    list.add("rate_hz", options.rate_hz, {0.1, 30}, "Of pictures and collections, at most");
    list.add("preview_px", options.preview_px, {40, 640}, "Longer side of a picture, at most");
    return list;
}

ViewerShell::ViewerShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                         const ViewerOptions& options)
    : bus_(bus), options_(options), decoder_(std::move(decoder)) {
    check_options("viewer", options_);
    if (options_.previews) {
        decoder_->subscribe(status_, 2, [this](auto frame) { on_frame(std::move(frame)); });
        bus_.subscribe(channels::kRegions, status_.guard([this](const auto& m) { on_regions(m); }), 2);
    }
    if (options_.collections) subscribe_collections();
}

void ViewerShell::subscribe_collections() {
    const auto take = [this](const char* channel, auto handle) {
        bus_.subscribe(channel, status_.guard([this, handle](const messages::RawMessage& m) {
            handle(m);
            is_new_ = true;
        }),
                       1);
    };
    take(channels::kMap, [this](const auto& m) { map_ = messages::plane_map_from(m.bytes); });
    take(channels::kTrajectory, [this](const auto& m) {
        const auto all = messages::from_message(messages::decode<trajectory_t>(m.bytes));
        trajectory_ = of_component(all, largest_component(all));  // as PLANEMAP_MAP
    });
    take(channels::kLocalFromOdom, [this](const auto& m) {
        local_from_odom_ = messages::from_message(messages::decode<bot_core::rigid_transform_t>(m.bytes));
    });
    take(channels::kBodyFromCamera, [this](const auto& m) {
        body_from_camera_ = messages::from_message(messages::decode<bot_core::rigid_transform_t>(m.bytes));
    });
}

bool ViewerShell::is_due(std::int64_t& last_us) const {
    const std::int64_t now = messages::now_us();
    if (std::abs(now - last_us) < static_cast<std::int64_t>(1e6 / options_.rate_hz)) return false;
    last_us = now;
    return true;
}

void ViewerShell::on_frame(std::shared_ptr<const messages::Frame> frame) {
    if (!is_due(previewed_us_)) return;
    const messages::ModuleStatus::Work work(status_);
    frame_ = std::move(frame);
    const CameraInfo& camera = frame_->camera();
    const auto reduction = [&](const PinholeCamera& c) {
        return reduction_to(c.width, c.height, options_.preview_px);
    };
    if (const auto color = frame_->color(reduction(camera.color)))
        publish_preview(channels::kPreviewColor, *color, frame_->utime());
    publish_preview(channels::kPreviewDepth, depth_preview(frame_->depth(), camera, reduction(camera.depth)),
                    frame_->utime());
}

void ViewerShell::on_regions(const messages::RawMessage& message) {
    if (!frame_) return;
    const messages::FrameRegions regions =
        messages::from_message(messages::decode<planar_regions_t>(message.bytes));
    if (regions.utime != frame_->utime()) return;
    const messages::ModuleStatus::Work work(status_);
    const CameraInfo& camera = frame_->camera();
    const int reduction = reduction_to(camera.depth.width, camera.depth.height, options_.preview_px);
    publish_preview(channels::kPreviewRegions,
                    region_preview(frame_->depth(), camera, regions.regions, reduction), regions.utime);
    frame_.reset();
}

void ViewerShell::publish_preview(const char* channel, const RgbImage& image, std::int64_t utime) {
    for (const int quality : {80, 50, 20}) {
        const bot_core::image_t message =
            messages::color_image_message(image, utime, messages::ColorEncoding::kJpeg, quality);
        if (static_cast<std::size_t>(message.getEncodedSize()) > kMostBytes) continue;
        bus_.publish(channel, message);
        status_.published();
        return;
    }
    status_.lost("previews too large for lcm-spy");
}

void ViewerShell::publish_collections() {
    // The map lies in the world, which loop closures move about the local frame.
    const Pose odom_from_world =
        trajectory_ ? trajectory_->world_from_odom.inverse() : Pose(Pose::Identity());
    const Pose local_from_world = *local_from_odom_ * odom_from_world;
    bus_.publish(channels::kObjectCollection, local_frame_collection());
    if (trajectory_) {
        bus_.publish(channels::kObjectCollection,
                     keyframe_collection(*trajectory_, local_from_world,
                                         body_from_camera_.value_or(Pose(Pose::Identity()))));
    }
    if (map_) bus_.publish(channels::kPointsCollection, plane_collection(*map_, local_from_world));
    status_.published();
}

int ViewerShell::poll() {
    if (!options_.collections) return 100;
    status_.set_text(local_from_odom_ ? ""
                                      : "collections wait for the local frame, which the odometry tells");
    if (local_from_odom_ && is_new_ && is_due(drawn_us_)) {
        publish_collections();
        is_new_ = false;
    }
    return 50;
}

}  // namespace planemap::viewer
