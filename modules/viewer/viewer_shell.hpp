// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/option_list.hpp"
#include "core/plane_map.hpp"
#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"

namespace planemap::viewer {

struct ViewerOptions {
    double rate_hz = 2;
    int preview_px = 320;
    bool previews = true;     ///< for lcm-spy
    bool collections = true;  ///< for Director and libbot's viewers
};

OptionList options_of(ViewerOptions& options);

/// What people look at, made of what is on the bus anyhow, so that nothing is slowed when nobody looks:
/// - previews of colour, depth and regions as JPEG of less than kMostBytes: what lcm-spy's receiver takes;
/// - planes and keyframes as vs.* collections in the local frame, once PLANEMAP_LOCAL_FROM_ODOM tells it.
class ViewerShell : public messages::Shell {
  public:
    static constexpr std::size_t kMostBytes = 60000;  ///< of a preview's message

    ViewerShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                const ViewerOptions& options);

    messages::ModuleStatus& status() override { return status_; }
    int poll() override;

  private:
    void on_frame(std::shared_ptr<const messages::Frame> frame);
    void on_regions(const messages::RawMessage& message);
    void subscribe_collections();
    bool is_due(std::int64_t& last_us) const;
    void publish_preview(const char* channel, const RgbImage& image, std::int64_t utime);
    void publish_collections();

    messages::Bus& bus_;
    ViewerOptions options_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    messages::ModuleStatus status_{"viewer"};
    std::int64_t previewed_us_ = 0, drawn_us_ = 0;  ///< wall clock
    std::shared_ptr<const messages::Frame> frame_;  ///< of the last previews: its regions may come yet
    std::optional<PlaneMap> map_;
    std::optional<KeyframeTrajectory> trajectory_;
    std::optional<Pose> local_from_odom_, body_from_camera_;
    bool is_new_ = false;  ///< something came that was not drawn yet
};

}  // namespace planemap::viewer
