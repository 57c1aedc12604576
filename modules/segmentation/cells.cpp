// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "segmentation/cell_grid.hpp"
#include "segmentation/growing.hpp"
#include "segmentation/shape.hpp"

namespace planemap {

namespace {

class CellSegmenter : public Segmenter {
  public:
    explicit CellSegmenter(const CellOptions& options) : options_(options), grower_(options) {}

    void segment(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) override {
        check_input(depth, camera);
        grid_.reset(depth, camera, options_.cell_fraction * depth.width);
        min_pixels_ = std::max(3.0, options_.min_region_fraction * depth.width * depth.height);
        fit_cells(camera);
        grower_.grow(map_, min_pixels_);
        label_pixels(depth, camera, out.labels);
        fit_regions(camera, out);
        tracer_.trace_all(out.labels, camera, out.regions);
    }

  private:
    /// The labels that may occur in a cell, and how many of its pixels carry them.
    struct CellLabels {
        std::size_t size = 0;
        std::array<std::uint16_t, CellGrid::kMaxCandidates> label{};
        std::array<int, CellGrid::kMaxCandidates> pixels{};
    };

    void fit_cells(const CameraInfo& camera);
    void label_pixels(const DepthImage& depth, const CameraInfo& camera, Image<std::uint16_t>& labels);
    void label_cell(int cell, const BorderBand& band, Image<std::uint16_t>& labels);
    bool offer(int cell, std::uint16_t label);
    void fit_regions(const CameraInfo& camera, Segmentation& out);
    void rename_labels(const std::vector<std::uint16_t>& new_name, Image<std::uint16_t>& labels) const;

    CellOptions options_;
    double min_pixels_ = 0;
    CellGrid grid_;
    CellMap map_;
    RegionGrower grower_;
    std::vector<InverseDepthSums> cell_sums_;  // unweighted, of all valid pixels of each cell
    std::vector<CellLabels> cell_labels_;
    std::vector<int> changed_, next_changed_;
    ShapeTracer tracer_;
};

/// Standard deviation of inverse depth that a standard deviation of depth means.
double inverse_depth_sigma(double sigma, double z) {
    return sigma / (z * z);
}

void CellSegmenter::fit_cells(const CameraInfo& camera) {
    map_.columns = grid_.columns();
    map_.rows = grid_.rows();
    map_.cell_x = grid_.cell_px() / camera.depth.fx;
    map_.noise = camera.noise;
    map_.cells.assign(static_cast<std::size_t>(grid_.size()), Cell{});
    cell_sums_.resize(static_cast<std::size_t>(grid_.size()));
    const double least = std::max(3.0, options_.min_fill * grid_.cell_px() * grid_.cell_px());
    const double unit_sigma = 1 / camera.depth_units_per_metre / std::sqrt(12.0);  // of rounding to raw units
    for (int i = 0; i < grid_.size(); ++i) {
        const InverseDepthSums& sums = cell_sums_[static_cast<std::size_t>(i)] = grid_.inverse_depth_sums(i);
        if (sums.n < least) continue;
        Cell& cell = map_.cells[static_cast<std::size_t>(i)];
        cell.fit = sums.fit();
        if (!cell.fit.valid) continue;
        cell.pixels = sums.n;
        cell.z = 1 / cell.fit.w;
        cell.sigma = std::hypot(camera.noise.sigma(cell.z), unit_sigma);
        const double sigma = inverse_depth_sigma(cell.sigma, cell.z);
        cell.sums = 1 / (sigma * sigma) * sums;
        // At a grazing angle an error of the pixel's place becomes one of depth.
        const double lateral = options_.lateral_px * std::hypot(cell.fit.plane.a / camera.depth.fx,
                                                                cell.fit.plane.b / camera.depth.fy);
        cell.planar = cell.fit.mse <= options_.planarity_sigmas * options_.planarity_sigmas *
                                          (sigma * sigma + lateral * lateral);
        cell.angle_error = std::atan(cell.sigma / cell.z / map_.cell_x);
    }
}

bool CellSegmenter::offer(int cell, std::uint16_t label) {
    const std::uint16_t own = grower_.label_of_cell()[static_cast<std::size_t>(cell)];
    if (own != 0 && own != label) return false;
    CellLabels& list = cell_labels_[static_cast<std::size_t>(cell)];
    const auto end = list.label.begin() + static_cast<std::ptrdiff_t>(list.size);
    if (list.size == list.label.size() || std::find(list.label.begin(), end, label) != end) return false;
    list.label[list.size++] = label;
    return true;
}

void CellSegmenter::label_cell(int cell, const BorderBand& band, Image<std::uint16_t>& labels) {
    std::array<Candidate, CellGrid::kMaxCandidates> candidates;
    CellLabels& list = cell_labels_[static_cast<std::size_t>(cell)];
    for (std::size_t k = 0; k < list.size; ++k)
        candidates[k] = {list.label[k], grower_.planes()[list.label[k] - 1u]};
    list.pixels = grid_.label(cell, std::span(candidates).first(list.size), band, labels);
}

void CellSegmenter::label_pixels(const DepthImage& depth, const CameraInfo& camera,
                                 Image<std::uint16_t>& labels) {
    labels.width = depth.width;
    labels.height = depth.height;
    labels.pixels.assign(depth.pixels.size(), 0);
    cell_labels_.assign(static_cast<std::size_t>(grid_.size()), CellLabels{});

    // A cell of a region keeps to that region, and offers its label to the eight cells around it; another
    // cell where enough pixels took a label offers it on to its four neighbours.
    const BorderBand band{options_.thickness_m, options_.thickness_sigmas, camera.noise};
    const int columns = grid_.columns(), rows = grid_.rows();
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const std::uint16_t label = grower_.label_of_cell()[static_cast<std::size_t>(y * columns + x)];
            if (label == 0) continue;
            for (int ny = std::max(0, y - 1); ny <= std::min(rows - 1, y + 1); ++ny) {
                for (int nx = std::max(0, x - 1); nx <= std::min(columns - 1, x + 1); ++nx)
                    offer(ny * columns + nx, label);
            }
        }
    }
    changed_.clear();
    for (int i = 0; i < grid_.size(); ++i) {
        if (cell_labels_[static_cast<std::size_t>(i)].size > 0) changed_.push_back(i);
    }
    constexpr int kRounds = 3;
    const int enough = grid_.cell_px() * grid_.cell_px() / 4;
    for (int round = 0; round < kRounds && !changed_.empty(); ++round) {
        for (const int i : changed_) label_cell(i, band, labels);
        next_changed_.clear();
        for (const int i : changed_) {
            if (grower_.label_of_cell()[static_cast<std::size_t>(i)] != 0) continue;  // has offered already
            const int x = i % columns, y = i / columns;
            const CellLabels& list = cell_labels_[static_cast<std::size_t>(i)];
            for (std::size_t k = 0; k < list.size; ++k) {
                if (list.pixels[k] < enough) continue;
                const std::uint16_t label = list.label[k];
                if (x > 0 && offer(i - 1, label)) next_changed_.push_back(i - 1);
                if (x + 1 < columns && offer(i + 1, label)) next_changed_.push_back(i + 1);
                if (y > 0 && offer(i - columns, label)) next_changed_.push_back(i - columns);
                if (y + 1 < rows && offer(i + columns, label)) next_changed_.push_back(i + columns);
            }
        }
        std::sort(next_changed_.begin(), next_changed_.end());
        next_changed_.erase(std::unique(next_changed_.begin(), next_changed_.end()), next_changed_.end());
        changed_.swap(next_changed_);
    }
}

void CellSegmenter::fit_regions(const CameraInfo& camera, Segmentation& out) {
    struct Sums {
        InverseDepthSums inverse_depth;
        Moments moments;
    };
    std::vector<Sums> sums(grower_.planes().size());
    for (int i = 0; i < grid_.size(); ++i) {
        const CellLabels& list = cell_labels_[static_cast<std::size_t>(i)];
        const InverseDepthSums& whole = cell_sums_[static_cast<std::size_t>(i)];
        for (std::size_t k = 0; k < list.size; ++k) {
            if (list.pixels[k] == 0) continue;
            const std::uint16_t label = list.label[k];
            const Candidate candidate{label, grower_.planes()[label - 1u]};
            const InverseDepthSums part =
                list.pixels[k] == whole.n ? whole : grid_.inverse_depth_sums(i, out.labels, candidate);
            const double z = part.n / part.w;
            const double sigma = inverse_depth_sigma(std::max(camera.noise.sigma(z), 1e-6), z);
            sums[label - 1u].inverse_depth += 1 / (sigma * sigma) * part;
            sums[label - 1u].moments += grid_.moments(i, out.labels, candidate);
        }
    }

    std::vector<std::uint16_t> order;
    std::vector<InverseDepthFit> fits(sums.size());
    for (std::size_t r = 0; r < sums.size(); ++r) {
        fits[r] = sums[r].inverse_depth.fit();
        if (sums[r].moments.count >= min_pixels_ && fits[r].valid)
            order.push_back(static_cast<std::uint16_t>(r));
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
        return sums[a].moments.count > sums[b].moments.count;
    });

    std::vector<std::uint16_t> new_name(sums.size() + 1, 0);
    out.regions.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        PlanarRegion& region = out.regions[k];
        region.plane = fits[order[k]].plane.plane();
        region.moments = sums[order[k]].moments;
        const Eigen::Vector3d& n = region.plane.normal;
        const double offset = region.plane.signed_distance(region.moments.mean());
        region.rms = std::sqrt(std::max(0.0, n.dot(region.moments.covariance() * n)) + offset * offset);
        new_name[order[k] + 1u] = static_cast<std::uint16_t>(k + 1);
    }
    rename_labels(new_name, out.labels);
}

void CellSegmenter::rename_labels(const std::vector<std::uint16_t>& new_name,
                                  Image<std::uint16_t>& labels) const {
    for (std::uint16_t& label : labels.pixels) label = new_name[label];
}

}  // namespace

void CellOptions::check(const std::string& prefix, FieldErrors& errors) const {
    const auto positive = [&](double value, const char* field) {
        errors.require(std::isfinite(value) && value > 0, prefix + field, value, "finite and greater than 0");
    };
    const auto angle = [&](double value, const char* field) {
        errors.require(value > 0 && value < 90, prefix + field, value, "between 0 and 90, both exclusive");
    };
    errors.require(cell_fraction > 0 && cell_fraction <= 1, prefix + "cell_fraction", cell_fraction,
                   "greater than 0, at most 1");
    errors.require(min_region_fraction >= 0 && min_region_fraction <= 1, prefix + "min_region_fraction",
                   min_region_fraction, "0 to 1");
    errors.require(min_fill > 0 && min_fill <= 1, prefix + "min_fill", min_fill, "greater than 0, at most 1");
    positive(planarity_sigmas, "planarity_sigmas");
    errors.require(std::isfinite(lateral_px) && lateral_px >= 0, prefix + "lateral_px", lateral_px,
                   "finite and at least 0");
    positive(step_m, "step_m");
    positive(step_sigmas, "step_sigmas");
    positive(grow_m, "grow_m");
    positive(grow_sigmas, "grow_sigmas");
    angle(grow_angle_deg, "grow_angle_deg");
    positive(merge_m, "merge_m");
    positive(merge_sigmas, "merge_sigmas");
    angle(merge_angle_deg, "merge_angle_deg");
    angle(bend_deg, "bend_deg");
    positive(thickness_m, "thickness_m");
    positive(thickness_sigmas, "thickness_sigmas");
}

std::unique_ptr<Segmenter> make_cell_segmenter(const CellOptions& options) {
    FieldErrors errors("cell options");
    options.check("", errors);
    errors.throw_if_any();
    return std::make_unique<CellSegmenter>(options);
}

}  // namespace planemap
