// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/geometry/angle.hpp"
#include "segmentation/cell_grid.hpp"
#include "segmentation/growing.hpp"
#include "segmentation/merging.hpp"
#include "segmentation/pixel_labels.hpp"
#include "segmentation/region_sums.hpp"

namespace planemap::segmentation {

namespace {

class CellSegmenter : public Segmenter {
  public:
    CellSegmenter(const CellOptions& options, const CellKernels& kernels)
        : options_(options), grid_(kernels), grower_(options) {}

  private:
    void find(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) override {
        min_pixels_ = std::max(3.0, options_.min_region_fraction * depth.width * depth.height);
        grid_.reset(depth, rules_for(camera));
        grid_.fit();
        grower_.grow({grid_.columns(), grid_.rows(), kCellPx / camera.depth.fx, camera.noise, grid_.cells()},
                     min_pixels_);
        labeller_.label(grid_, grower_.label_of_cell(), grower_.planes(),
                        {options_.thickness_m, options_.thickness_sigmas, camera.noise});
        std::vector<RegionSums>& sums = summer_.sum(grid_, labeller_, camera.noise);
        merge_pieces(camera, sums);
        make_regions(sums, out.regions);
        grid_.take_labels(out.labels);
    }

    CellRules rules_for(const CameraInfo& camera) const;
    void merge_pieces(const CameraInfo& camera, std::vector<RegionSums>& sums);
    void make_regions(const std::vector<RegionSums>& sums, std::vector<PlanarRegion>& regions);
    void rename_labels();

    CellOptions options_;
    double min_pixels_ = 0;
    CellGrid grid_;
    RegionGrower grower_;
    PixelLabeller labeller_;
    RegionSummer summer_;
    std::vector<MergeRegion> pieces_;  // the regions once more, as merging takes them
    MergedLabels merged_;              // of the pieces
    TouchList touching_;
    std::vector<std::uint16_t> order_, new_label_;
};

CellRules CellSegmenter::rules_for(const CameraInfo& camera) const {
    CellRules rules = sensor_rules(camera);
    rules.min_pixels = options_.min_fill * kCellPx * kCellPx;
    rules.planarity_sigmas = options_.planarity_sigmas;
    rules.lateral_px = options_.lateral_px;
    rules.grow_m = options_.grow_m;
    rules.grow_sigmas = options_.grow_sigmas;
    rules.grow_angle_rad = radians(options_.grow_angle_deg);
    return rules;
}

void CellSegmenter::merge_pieces(const CameraInfo& camera, std::vector<RegionSums>& region_sums) {
    // Now that the borders are final and the planes exact, pieces of one plane show that could not be told
    // before, when cells with a part of something else in them spoilt the planes.
    pieces_.clear();
    for (const RegionSums& sums : region_sums)
        pieces_.push_back({sums.weighted, sums.weighted.fit(), sums.points.n, sums.cells});
    touching_.clear();
    const int columns = grid_.columns();
    const auto meet = [&](const CellLabels& one, const CellLabels& other) {
        if (one.size == 1 && other.size == 1 && one.label[0] == other.label[0]) return;
        for (std::size_t k = 0; k < one.size; ++k) {
            for (std::size_t m = 0; m < other.size; ++m) {
                if (one.label[k] != other.label[m] && one.pixels[k] > 0 && other.pixels[m] > 0)
                    touching_.add(one.label[k], other.label[m], false, true);
            }
        }
    };
    for (int i = 0; i < grid_.size(); ++i) {
        const CellLabels& list = labeller_.cell_labels()[i];
        if (list.size > 1) meet(list, list);
        if (i % columns + 1 < columns) meet(list, labeller_.cell_labels()[i + 1]);
        if (i + columns < grid_.size()) meet(list, labeller_.cell_labels()[i + columns]);
    }
    merge_regions({options_.merge_m, options_.merge_sigmas, radians(options_.merge_angle_deg),
                   kCellPx / camera.depth.fx, camera.noise},
                  pieces_, touching_, merged_);
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        const std::size_t into = merged_.find(static_cast<std::uint16_t>(r + 1)) - 1u;
        if (into == r) continue;
        region_sums[into].points += region_sums[r].points;
        region_sums[r] = {};
    }
}

void CellSegmenter::make_regions(const std::vector<RegionSums>& region_sums,
                                 std::vector<PlanarRegion>& regions) {
    order_.clear();
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        if (region_sums[r].points.n >= min_pixels_ && pieces_[r].fit.valid)
            order_.push_back(static_cast<std::uint16_t>(r));
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint16_t a, std::uint16_t b) {
        return std::pair(-region_sums[a].points.n, a) < std::pair(-region_sums[b].points.n, b);
    });
    new_label_.assign(region_sums.size() + 1, 0);
    regions.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
        PlanarRegion& region = regions[k];
        region.box = {};
        region.plane = pieces_[order_[k]].fit.plane.plane();
        region.moments = region_sums[order_[k]].points.moments();
        const Eigen::Vector3d& n = region.plane.normal;
        const double offset = region.plane.signed_distance(region.moments.mean());
        region.rms = std::sqrt(std::max(0.0, n.dot(region.moments.covariance() * n)) + offset * offset);
        new_label_[order_[k] + 1u] = static_cast<std::uint16_t>(k + 1);
    }
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        new_label_[r + 1] = new_label_[merged_.find(static_cast<std::uint16_t>(r + 1))];
    }
    rename_labels();
}

void CellSegmenter::rename_labels() {
    const auto stays = [&](std::uint16_t label) { return new_label_[label] == label; };
    for (int i = 0; i < grid_.size(); ++i) {
        const CellLabels& list = labeller_.cell_labels()[i];
        if (list.size == 0 || (list.size == 1 && stays(list.label[0]))) continue;
        if (list.pixels[0] == kCellPx * kCellPx) {
            grid_.fill(grid_.place(i), new_label_[list.label[0]]);
        } else if (!std::all_of(list.label.begin(), list.label.begin() + list.size, stays)) {
            grid_.rename(grid_.place(i), new_label_);
        }
    }
}

}  // namespace

std::unique_ptr<Segmenter> make_cell_segmenter(const CellOptions& options, const CellKernels& kernels) {
    options.validate();
    return std::make_unique<CellSegmenter>(options, kernels);
}

}  // namespace planemap::segmentation
