// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/scripted_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "messages/image_codec.hpp"

namespace planemap::bench_odometry {

namespace {

std::uint8_t dimmed(std::uint8_t value, double light) {
    return static_cast<std::uint8_t>(std::lround(light * value));
}

void dim(double light, RgbImage& image) {
    for (Rgb& pixel : image.pixels)
        pixel = {dimmed(pixel.r, light), dimmed(pixel.g, light), dimmed(pixel.b, light)};
}

/// Each pixel becomes the mean of those at most `radius` beside it in its row.
void smear(int radius, RgbImage& image) {
    std::vector<std::array<int, 3>> sums(static_cast<std::size_t>(image.width) + 1);
    for (int v = 0; v < image.height; ++v) {
        Rgb* row = image.row(v);
        for (int u = 0; u < image.width; ++u) {
            const auto i = static_cast<std::size_t>(u);
            sums[i + 1] = {sums[i][0] + row[u].r, sums[i][1] + row[u].g, sums[i][2] + row[u].b};
        }
        for (int u = 0; u < image.width; ++u) {
            const int from = std::max(0, u - radius), to = std::min(image.width, u + radius + 1);
            const auto &low = sums[static_cast<std::size_t>(from)],
                       &high = sums[static_cast<std::size_t>(to)];
            const int count = to - from;
            row[u] = {static_cast<std::uint8_t>((high[0] - low[0]) / count),
                      static_cast<std::uint8_t>((high[1] - low[1]) / count),
                      static_cast<std::uint8_t>((high[2] - low[2]) / count)};
        }
    }
}

bool has_color(const SensorFrame& frame) {
    return !frame.color.empty() || !frame.color_jpeg.empty();
}

constexpr int kQuality = 95;  // of a JPEG that is made anew

/// The same images, seen otherwise, in the form that they had: a stream whose form changes is another one.
void disturb(const Shown& shown, const PinholeCamera& camera, SensorFrame& frame) {
    if (shown.covered) {
        std::fill(frame.depth.pixels.begin(), frame.depth.pixels.end(), std::uint16_t{0});
        if (!frame.depth_zipped.empty()) frame.depth_zipped = messages::encode_zipped_depth(frame.depth);
    }
    if (!has_color(frame) || (!shown.covered && shown.light == 1 && shown.smear == 0)) return;
    const bool is_jpeg = !frame.color_jpeg.empty();
    RgbImage color =
        is_jpeg ? messages::decode_jpeg_colors(frame.color_jpeg, camera.width, camera.height) : frame.color;
    dim(shown.covered ? 0 : shown.light, color);
    if (shown.smear > 0) smear(static_cast<int>(std::lround(shown.smear * color.width / 2)), color);
    if (is_jpeg)
        frame.color_jpeg = messages::encode_jpeg(color, kQuality);
    else
        frame.color = std::move(color);
}

}  // namespace

ScriptedSource::ScriptedSource(std::unique_ptr<FrameSource> images, Script script)
    : SourceAround(std::move(images)), script_(std::move(script)) {
    for (std::size_t i = 0; i < script_.size(); ++i) {
        for (const std::size_t index : {script_[i].at, script_[i].color, script_[i].depth}) {
            if (last_use_.size() <= index) last_use_.resize(index + 1, 0);
            last_use_[index] = i;
        }
    }
}

/// The frame of that number, read up to it; nullptr where the source ends before.
const SensorFrame* ScriptedSource::find(std::size_t index) {
    while (read_ <= index) {
        SensorFrame frame;
        const ReadResult result = source().next(frame);
        if (result.status == ReadResult::Status::kEnd) return nullptr;
        if (result.status != ReadResult::Status::kFrame) continue;
        if (last_use_[read_] >= next_) kept_[read_] = std::move(frame);
        ++read_;
    }
    return &kept_.at(index);
}

/// What is not shown any more.
void ScriptedSource::forget() {
    std::erase_if(kept_, [&](const auto& entry) { return last_use_[entry.first] < next_; });
}

ReadResult ScriptedSource::next(SensorFrame& frame) {
    frame = {};
    ReadResult result;
    if (next_ == script_.size()) return result;
    const Shown& shown = script_[next_];
    for (const std::size_t index : {shown.at, shown.color, shown.depth})
        if (find(index) == nullptr) return result;
    const SensorFrame &at = kept_.at(shown.at), &color = kept_.at(shown.color),
                      &depth = kept_.at(shown.depth);
    frame.utime = at.utime + shown.later_us;
    frame.depth = depth.depth;
    frame.depth_zipped = depth.depth_zipped;
    frame.color_jpeg = color.color_jpeg;
    frame.color = color.color;
    if (has_color(frame)) {
        // Where this moment has no colour of its own, the image takes its depth's stamp.
        const std::int64_t now = at.color_utime != 0 ? at.color_utime : at.utime;
        frame.color_utime = (shown.keeps_color_stamp ? color.color_utime : now) + shown.later_us;
    }
    disturb(shown, source().camera().color, frame);
    moments_.push_back(at.utime);
    ++next_;
    forget();
    result.status = ReadResult::Status::kFrame;
    return result;
}

}  // namespace planemap::bench_odometry
