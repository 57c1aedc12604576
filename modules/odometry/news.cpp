// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/news.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/time_step.hpp"

namespace planemap::odometry {
namespace {

constexpr std::size_t kBuffers = 4;  // that a driver fills in turn
constexpr std::size_t kSteps = 9;
constexpr double kMostPeriods = 1.5;  // beside its depth: the one before or after would have been nearer
constexpr std::int64_t kMostBeside_us = 100000;  // the same where frames were left out, or of the first one
constexpr std::size_t kOneIn = 200;              // pixels may differ
constexpr std::size_t kEnoughReadings = 100;     // for two depth images to be the same
constexpr std::size_t kRun = 512;                // pixels that are compared without a look at the result
constexpr int kContrast = 3;  // grey levels; without any, two images are alike that nobody repeated

/// Whether an image shows anything.
bool has_contrast(const GrayImage& image) {
    const int first = image.pixels.front();
    std::size_t apart = 0;
    for (const std::uint8_t pixel : image.pixels) {
        apart += std::abs(pixel - first) >= kContrast ? 1 : 0;
        if (apart > image.pixels.size() / kOneIn) return true;
    }
    return false;
}

/// In how many pixels of the run from `begin` on two images of one size are as asked.
template <typename Pixel, typename Ask>
std::size_t count_of_run(std::size_t begin, const std::vector<Pixel>& a, const std::vector<Pixel>& b,
                         const Ask& ask) {
    const std::size_t end = std::min(begin + kRun, a.size());
    int count = 0;
    for (std::size_t i = begin; i < end; ++i) count += ask(a[i], b[i]) ? 1 : 0;
    return static_cast<std::size_t>(count);
}

template <typename Image>
bool repeats_any(const Image& image, const std::deque<Image>& last) {
    return std::any_of(last.begin(), last.end(), [&](const Image& one) { return is_repeated(image, one); });
}

template <typename Image>
void remember(const Image& image, std::deque<Image>& last) {
    if (last.size() < kBuffers) {
        last.push_back(image);
        return;
    }
    std::rotate(last.begin(), last.begin() + 1, last.end());
    last.back() = image;  // in the memory of the oldest one
}

}  // namespace

bool is_repeated(const GrayImage& image, const GrayImage& last) {
    if (image.width != last.width || image.height != last.height || image.empty()) return false;
    const std::size_t most = image.pixels.size() / kOneIn;
    std::size_t differ = 0;
    // Images that differ do so within the first rows: that is all they cost.
    for (std::size_t i = 0; i < image.pixels.size() && differ <= most; i += kRun)
        differ += count_of_run(i, image.pixels, last.pixels, [](auto a, auto b) { return a != b; });
    return differ <= most && has_contrast(image);
}

bool is_repeated(const DepthImage& image, const DepthImage& last) {
    if (image.width != last.width || image.height != last.height || image.empty()) return false;
    const std::size_t most = image.pixels.size() / kOneIn;
    std::size_t differ = 0, readings = 0;
    for (std::size_t i = 0; i < image.pixels.size() && differ <= most; i += kRun) {
        readings += count_of_run(i, image.pixels, last.pixels, [](std::uint16_t a, std::uint16_t b) {
            return is_valid_depth(a) || is_valid_depth(b);
        });
        differ += count_of_run(i, image.pixels, last.pixels, [](auto a, auto b) { return a != b; });
    }
    return readings >= kEnoughReadings && differ <= std::min(most, readings / kOneIn);
}

/// Whether the colour image is further from the depth image than the rate of frames explains.
bool NewsWatch::is_late(const OdometryFrame& frame) const {
    if (frame.color_utime == 0) return false;
    std::int64_t most_us = kMostBeside_us;
    if (!steps_us_.empty()) {
        std::vector<std::int64_t> steps(steps_us_.begin(), steps_us_.end());
        most_us = std::min(most_us,
                           static_cast<std::int64_t>(kMostPeriods * static_cast<double>(median_step(steps))));
    }
    return std::abs(frame.color_utime - frame.utime) > most_us;
}

News NewsWatch::see(const OdometryFrame& frame) {
    if (utime_ && frame.utime <= *utime_) *this = {};  // another run: its images are nobody's repetition
    News news;
    if (frame.gray != nullptr) {
        if (repeats_any(*frame.gray, grays_) || (frame.color_utime != 0 && frame.color_utime == color_utime_))
            news.color = News::Image::kRepeated;
        else if (is_late(frame))
            news.color = News::Image::kLate;
        else
            news.color = News::Image::kNew;
        if (news.color != News::Image::kRepeated) {
            remember(*frame.gray, grays_);
            color_utime_ = frame.color_utime;
        }
    }
    news.depth = repeats_any(*frame.depth, depths_) ? News::Image::kRepeated : News::Image::kNew;
    if (news.depth == News::Image::kNew) remember(*frame.depth, depths_);
    if (utime_) {
        steps_us_.push_back(frame.utime - *utime_);
        if (steps_us_.size() > kSteps) steps_us_.pop_front();
    }
    utime_ = frame.utime;
    return news;
}

}  // namespace planemap::odometry
