// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/registration_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace planemap::odometry {

namespace {

constexpr std::int64_t kEvery_us = 500000;
constexpr int kMinSilhouettes = 3000;
/// What a sensor's own depth edges err by is no displacement. How clear, and how much clearer than elsewhere
/// (both less 1): registered recordings have 0.64 to 2.7 in place, and 2.0 to 6 times as much as elsewhere;
/// unregistered ones, taken to be registered, 0.47 to 1.0 beside it, and 1.8 to 2.2 times; of images that
/// have nothing to do with each other 1 in 100 has more than 1.75 times.
constexpr double kMinDisplacement_px = 6, kMinClearness = 1.25, kMinAdvantage = 1.7;
/// Around the clearest displacement, which others are not.
constexpr double kNear_px = 8;
/// What is hidden lies so much further away, and begins at most so far beside the silhouette: a sensor casts
/// shadows without readings.
constexpr double kBehind = 1.15;
constexpr int kShadow_px = 24;
/// Of displacements that are tried.
constexpr int kMostShift_px = 24, kMostStretch_px = 80, kStretchStep_px = 8;

/// The side on which the nearer surface ends at (u, v): 1 to the right of u, -1 to the left; 0: it does not.
int silhouette_at(const DepthImage& depth, int u, int v) {
    const std::uint16_t* const row = depth.row(v);
    if (!is_valid_depth(row[u])) return 0;
    for (const int side : {1, -1}) {
        int beside = u + side;
        const int last = std::clamp(u + side * kShadow_px, 0, depth.width - 1);
        while (beside != last && !is_valid_depth(row[beside])) beside += side;
        if (beside >= 0 && beside < depth.width && is_valid_depth(row[beside]) &&
            row[beside] > kBehind * row[u])
            return side;
    }
    return 0;
}

/// Step of brightness between u and u + 1, of three rows.
int step(const GrayImage& gray, int u, int v) {
    int sum = 0;
    for (int row = v - 1; row <= v + 1; ++row) sum += gray(u + 1, row) - gray(u, row);
    return std::abs(sum);
}

}  // namespace

bool RegistrationCheck::see(std::int64_t utime, const DepthImage& depth, const GrayImage& gray) {
    if (seen_ == kFrames || (seen_ > 0 && std::abs(utime - last_utime_) < kEvery_us)) return false;
    if (gray.width != depth.width || gray.height != depth.height) return false;
    last_utime_ = utime;
    for (int v = 1; v + 1 < depth.height; v += 2) {
        for (int u = kReach; u + kReach + 1 < depth.width; ++u)
            if (const int side = silhouette_at(depth, u, v); side != 0) vote(gray, side > 0 ? u : u - 1, v);
    }
    return ++seen_ == kFrames;
}

/// A silhouette between u and u + 1.
void RegistrationCheck::vote(const GrayImage& gray, int u, int v) {
    if (u < kReach) return;
    constexpr std::size_t kWidth = 2 * kReach + 1;
    std::array<int, kWidth> steps{};
    double sum = 0;
    for (std::size_t i = 0; i < kWidth; ++i)
        sum += steps[i] = step(gray, u - kReach + static_cast<int>(i), v);
    const double mean = sum / kWidth + 6;  // of noise alone
    const auto column = static_cast<std::size_t>(u * kColumns / gray.width);
    for (std::size_t i = 0; i < kWidth; ++i) steps_[column * kWidth + i] += std::min(steps[i] / mean, 5.0);
    ++counts_[column];
    ++silhouettes_;
}

/// The mean step beside all silhouettes at a displacement, within two pixels of it.
double RegistrationCheck::steps_at(double shift_px, double stretch_px) const {
    constexpr int kBlur_px = 2;
    double sum = 0, count = 0;
    for (int column = 0; column < kColumns; ++column) {
        const double x = (column + 0.5) / kColumns - 0.5;
        const int at = static_cast<int>(std::lround(shift_px + stretch_px * x));
        if (std::abs(at) + kBlur_px > kReach) continue;
        for (int d = at - kBlur_px; d <= at + kBlur_px; ++d) {
            const int index = column * (2 * kReach + 1) + d + kReach;
            sum += steps_[static_cast<std::size_t>(index)] / (2 * kBlur_px + 1);
        }
        count += counts_[static_cast<std::size_t>(column)];
    }
    return count > 0 ? sum / count : 0;
}

double RegistrationCheck::Displacement::most_px() const {
    return std::abs(shift_px) + std::abs(stretch_px) / 2;
}

std::optional<RegistrationCheck::Displacement> RegistrationCheck::displacement() const {
    if (seen_ < kFrames || silhouettes_ < kMinSilhouettes) return std::nullopt;
    std::vector<Displacement> all;
    for (int stretch = -kMostStretch_px; stretch <= kMostStretch_px; stretch += kStretchStep_px) {
        for (int shift = -kMostShift_px; shift <= kMostShift_px; ++shift) {
            const auto shift_px = static_cast<double>(shift), stretch_px = static_cast<double>(stretch);
            all.push_back({shift_px, stretch_px, steps_at(shift_px, stretch_px), 0});
        }
    }
    const auto is_less = [](const Displacement& a, const Displacement& b) {
        return a.clearness < b.clearness;
    };
    Displacement best = *std::max_element(all.begin(), all.end(), is_less);
    for (const Displacement& other : all)
        if (std::abs(other.shift_px - best.shift_px) > kNear_px ||
            std::abs(other.stretch_px - best.stretch_px) > 4 * kNear_px)
            best.clearness_elsewhere = std::max(best.clearness_elsewhere, other.clearness);
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end(),
                     is_less);
    const double anywhere = all[all.size() / 2].clearness;
    if (anywhere <= 0) return std::nullopt;
    best.clearness /= anywhere;
    best.clearness_elsewhere /= anywhere;
    return best;
}

std::optional<std::string> RegistrationCheck::complaint() const {
    const std::optional<Displacement> found = displacement();
    if (!found || found->most_px() < kMinDisplacement_px || found->clearness < kMinClearness ||
        found->clearness - 1 < kMinAdvantage * (found->clearness_elsewhere - 1))
        return std::nullopt;
    return "depth looks unregistered, or its camera wrongly described: its edges lie up to " +
           std::to_string(std::lround(found->most_px())) + " px beside colour's, " +
           std::to_string(std::lround(std::abs(found->shift_px))) + " px in the middle";
}

}  // namespace planemap::odometry
