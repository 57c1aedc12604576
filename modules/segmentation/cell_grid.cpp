// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_grid.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "segmentation/shape.hpp"

namespace planemap::segmentation {

namespace {

constexpr int kGroup = 8;  // cells that a kernel takes at once

int cells_across(int pixels) {
    return (pixels + kCellPx - 1) / kCellPx;
}

}  // namespace

CellRules sensor_rules(const CameraInfo& camera) {
    const DepthRange range(camera);
    CellRules rules;
    rules.camera = camera.depth;
    rules.units_per_metre = camera.depth_units_per_metre;
    rules.low = range.low;
    rules.high = range.high;
    rules.noise = camera.noise;
    return rules;
}

void CellGrid::reset(const DepthImage& depth, const CellRules& rules) {
    rules_ = rules;
    width_ = depth.width;
    height_ = depth.height;
    columns_ = std::max(kGroup, cells_across(width_));
    rows_ = cells_across(height_);
    const int padded_width = columns_ * kCellPx, padded_height = rows_ * kCellPx;
    const std::size_t pixels =
        static_cast<std::size_t>(padded_width) * static_cast<std::size_t>(padded_height);
    if (padded_width == width_ && padded_height == height_) {
        depth_ = &depth;
    } else {
        padded_.width = padded_width;
        padded_.height = padded_height;
        padded_.pixels.assign(pixels, 0);
        for (int v = 0; v < height_; ++v) std::copy_n(depth.row(v), width_, padded_.row(v));
        depth_ = &padded_;
    }
    labels_.width = padded_width;
    labels_.height = padded_height;
    labels_.pixels.resize(pixels);
}

void CellGrid::fit() {
    cells_.resize(static_cast<std::size_t>(size()));
    sums_.resize(cells_.size());
    for (int y = 0; y < rows_; ++y) {
        for (int x = 0; x < columns_; x += kGroup) {
            const int first = std::min(x, columns_ - kGroup);  // the last group may overlap the one before
            const int u = first * kCellPx, v = y * kCellPx;
            const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(y) * columns_ + first;
            kernels_->fit(rules_, {depth_->row(v) + u, depth_->width, u, v}, cells_.data() + cell,
                          sums_.data() + cell);
        }
    }
}

Candidate CellGrid::candidate(const InverseDepthPlane& plane, std::uint16_t label) const {
    const double d = 1 / plane.steepness(), scale = d / rules_.units_per_metre;
    const PinholeCamera& camera = rules_.camera;
    return {scale * plane.at(-camera.cx / camera.fx, -camera.cy / camera.fy), scale * plane.a / camera.fx,
            scale * plane.b / camera.fy, d, label};
}

std::uint16_t CellGrid::depth_at(Place cell, const Candidate& candidate) const {
    const double line = candidate.start + candidate.right * (cell.x * kCellPx + 3.5) +
                        candidate.down * (cell.y * kCellPx + 3.5);
    const double reading = candidate.d / line;
    return line > 0 && reading < 65534 ? static_cast<std::uint16_t>(reading) : std::uint16_t{65534};
}

void CellGrid::label(Place cell, const BorderBand& band, std::span<const Candidate> candidates,
                     std::uint8_t* pixels) {
    const int u = cell.x * kCellPx, v = cell.y * kCellPx;
    kernels_->label(rules_, band, {depth_->row(v) + u, labels_.row(v) + u, depth_->width, u, v},
                    candidates.data(), std::min(candidates.size(), kMaxCandidates), pixels);
}

void CellGrid::fill(Place cell, std::uint16_t label) {
    for (int row = 0; row < kCellPx; ++row)
        std::fill_n(labels_.row(cell.y * kCellPx + row) + std::ptrdiff_t{cell.x} * kCellPx, kCellPx, label);
}

void CellGrid::sum(std::span<const Part> parts, PointSums* sums) const {
    // The rest of the eight sets are the last part again.
    std::array<LabelledPixels, kGroup> sets;
    for (std::size_t k = 0; k < sets.size(); ++k) {
        const Part& part = parts[std::min(k, parts.size() - 1)];
        const int u = part.cell.x * kCellPx, v = part.cell.y * kCellPx;
        sets[k] = {depth_->row(v) + u, labels_.row(v) + u, depth_->width, u, v, part.label, part.reference};
    }
    std::array<PointSums, kGroup> all;
    kernels_->sum(rules_, sets.data(), all.data());
    std::copy_n(all.begin(), parts.size(), sums);
}

void CellGrid::rename(Place cell, std::span<const std::uint16_t> new_label) {
    for (int row = 0; row < kCellPx; ++row) {
        std::uint16_t* pixels = labels_.row(cell.y * kCellPx + row) + std::ptrdiff_t{cell.x} * kCellPx;
        for (int i = 0; i < kCellPx; ++i) pixels[i] = new_label[pixels[i]];
    }
}

void CellGrid::take_labels(Image<std::uint16_t>& out) {
    if (labels_.width == width_ && labels_.height == height_) {
        std::swap(out, labels_);
        return;
    }
    out.width = width_;
    out.height = height_;
    out.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int v = 0; v < height_; ++v) std::copy_n(labels_.row(v), width_, out.row(v));
}

}  // namespace planemap::segmentation
