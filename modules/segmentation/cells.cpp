// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "segmentation/cell_grid.hpp"
#include "segmentation/growing.hpp"
#include "segmentation/merging.hpp"
#include "segmentation/shape.hpp"

namespace planemap {

namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Cosine of the angle between surfaces that cannot be one.
constexpr float kSimilar = 0.5f;

class CellSegmenter : public Segmenter {
  public:
    CellSegmenter(const CellOptions& options, const CellKernels& kernels)
        : options_(options), grid_(kernels), grower_(options) {}

    void segment(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) override {
        check_input(depth, camera);
        min_pixels_ = std::max(3.0, options_.min_region_fraction * depth.width * depth.height);
        grid_.reset(depth, rules_for(camera));
        grid_.fit();
        grower_.grow({grid_.columns(), grid_.rows(), kCellPx / camera.depth.fx, camera.noise, grid_.cells()},
                     min_pixels_);
        label_pixels({options_.thickness_m, options_.thickness_sigmas, camera.noise});
        sum_regions(camera);
        merge_pieces(camera);
        make_regions(out.regions);
        grid_.take_labels(out.labels);
        tracer_.trace_all(depth, out.labels, camera, out.regions);
    }

  private:
    /// The labels that may occur in a cell, and how many of its pixels carry them.
    struct CellLabels {
        std::uint8_t size = 0;
        std::array<std::uint8_t, kMaxCandidates> pixels{};
        std::array<std::uint16_t, kMaxCandidates> label{};
    };
    /// What a region's pixels add up to.
    struct RegionSums {
        PointSums points;    // unweighted
        PointSums weighted;  // by the noise
        int cells = 0;
    };

    CellRules rules_for(const CameraInfo& camera) const;
    void label_pixels(const BorderBand& band);
    void label_cells(const BorderBand& band);
    void label_cell(CellGrid::Place place, CellLabels& list, const BorderBand& band);
    bool offer(int cell, std::uint16_t label);
    void sum_regions(const CameraInfo& camera);
    void sum_waiting(const DepthNoise& noise);
    void add_sums(const DepthNoise& noise, std::uint16_t label, const PointSums& part, int cells);
    void merge_pieces(const CameraInfo& camera);
    void make_regions(std::vector<PlanarRegion>& regions);
    void rename_labels();

    CellOptions options_;
    double min_pixels_ = 0;
    CellGrid grid_;
    RegionGrower grower_;
    std::vector<CellLabels> cell_labels_;
    std::vector<Candidate> candidates_;  // of each region
    std::vector<Target> targets_;        // of each region
    std::vector<int> changed_, next_changed_;
    std::vector<std::uint8_t> waits_;      // cells in next_changed_
    std::vector<CellGrid::Part> waiting_;  // to be summed
    std::vector<RegionSums> region_sums_;
    std::vector<MergeRegion> pieces_;  // the regions once more, as merging takes them
    TouchList touching_;
    std::vector<std::uint16_t> order_, new_label_;
    ShapeTracer tracer_;
};

CellRules CellSegmenter::rules_for(const CameraInfo& camera) const {
    const DepthRange range(camera);
    CellRules rules;
    rules.camera = camera.depth;
    rules.units_per_metre = camera.depth_units_per_metre;
    rules.low = range.low;
    rules.high = range.high;
    rules.noise = camera.noise;
    rules.min_pixels = options_.min_fill * kCellPx * kCellPx;
    rules.planarity_sigmas = options_.planarity_sigmas;
    rules.lateral_px = options_.lateral_px;
    rules.grow_m = options_.grow_m;
    rules.grow_sigmas = options_.grow_sigmas;
    rules.grow_angle_rad = options_.grow_angle_deg * kRadians;
    return rules;
}

bool CellSegmenter::offer(int cell, std::uint16_t label) {
    CellLabels& list = cell_labels_[cell];
    const auto end = list.label.begin() + list.size;
    if (list.size == list.label.size() || std::find(list.label.begin(), end, label) != end) return false;
    // A stripe of a surface that lies otherwise is not part of the plane that cuts it.
    const Cell& fitted = grid_.cells()[cell];
    if (fitted.planar() && targets_[label - 1].cosine(fitted) < std::min(fitted.cos_limit, kSimilar))
        return false;
    list.label[list.size] = label;
    list.pixels[list.size++] = 0;
    return true;
}

void CellSegmenter::label_cell(CellGrid::Place place, CellLabels& list, const BorderBand& band) {
    if (list.size == 1) {
        grid_.label(place, band, std::span(candidates_).subspan(list.label[0] - 1, 1), list.pixels.data());
        return;
    }
    std::array<Candidate, kMaxCandidates> candidates;
    for (std::size_t k = 0; k < list.size; ++k) candidates[k] = candidates_[list.label[k] - 1];
    grid_.label(place, band, std::span(candidates).first(list.size), list.pixels.data());
}

void CellSegmenter::label_cells(const BorderBand& band) {
    // A cell of a region keeps to that region, and offers its label to the eight cells around it.
    const std::vector<std::uint16_t>& labels = grower_.label_of_cell();
    const int columns = grid_.columns(), rows = grid_.rows();
    cell_labels_.resize(static_cast<std::size_t>(grid_.size()));
    waits_.assign(cell_labels_.size(), 0);
    changed_.clear();
    for (int y = 0, i = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x, ++i) {
            CellLabels& list = cell_labels_[i];
            list.size = 0;
            if (labels[i] != 0) {
                list.size = 1;
                list.label[0] = labels[i];
                grid_.label({x, y}, band, {&candidates_[labels[i] - 1], 1}, list.pixels.data());
                continue;
            }
            const int left = x > 0 ? -1 : 0, right = x + 1 < columns ? 1 : 0;
            for (int down = y > 0 ? -1 : 0; down <= (y + 1 < rows ? 1 : 0); ++down) {
                const std::uint16_t* row = &labels[i + down * columns];
                for (int k = left; k <= right; ++k) {
                    if (row[k] != 0) offer(i, row[k]);
                }
            }
            if (list.size > 0) {
                changed_.push_back(i);
                label_cell({x, y}, list, band);
            } else {
                grid_.fill({x, y}, 0);
            }
        }
    }
}

void CellSegmenter::label_pixels(const BorderBand& band) {
    candidates_.clear();
    targets_.clear();
    for (const InverseDepthPlane& plane : grower_.planes()) {
        targets_.emplace_back(plane);
        candidates_.push_back(grid_.candidate(plane, static_cast<std::uint16_t>(targets_.size())));
    }
    label_cells(band);
    // A cell without region where enough pixels took a label offers it on to its four neighbours.
    const std::vector<std::uint16_t>& labels = grower_.label_of_cell();
    const int columns = grid_.columns(), rows = grid_.rows();
    const auto offer_on = [&](int cell, std::uint16_t label) {
        if (labels[cell] != 0 || !offer(cell, label) || waits_[cell] != 0) return;
        waits_[cell] = 1;
        next_changed_.push_back(cell);
    };
    constexpr int kRounds = 32;
    constexpr int kEnough = kCellPx * kCellPx / 10;
    for (int round = 1; round < kRounds && !changed_.empty(); ++round) {
        next_changed_.clear();
        for (const int i : changed_) {
            const auto [x, y] = grid_.place(i);
            const CellLabels& list = cell_labels_[i];
            for (std::size_t k = 0; k < list.size; ++k) {
                if (list.pixels[k] < kEnough) continue;
                if (x > 0) offer_on(i - 1, list.label[k]);
                if (x + 1 < columns) offer_on(i + 1, list.label[k]);
                if (y > 0) offer_on(i - columns, list.label[k]);
                if (y + 1 < rows) offer_on(i + columns, list.label[k]);
            }
        }
        changed_.swap(next_changed_);
        for (const int i : changed_) {
            label_cell(grid_.place(i), cell_labels_[i], band);
            waits_[i] = 0;
        }
    }
}

/// Adds the sums as they would be without noise, weighted by its variance. Inverse depth is what has
/// symmetric errors, so that its reciprocal z is too large in the mean by `relative2` = (sigma / z)^2, and
/// z^2 by three times that.
void add_unbiased(PointSums& to, PointSums part, double relative2) {
    const double first = 1 - relative2, second = 1 - 3 * relative2;
    for (double* sum : {&part.x, &part.y, &part.z}) *sum *= first;
    for (double* sum : {&part.xx, &part.xy, &part.xz, &part.yy, &part.yz, &part.zz}) *sum *= second;
    to.add(1 / relative2, part);
}

void CellSegmenter::add_sums(const DepthNoise& noise, std::uint16_t label, const PointSums& part, int cells) {
    const double z = part.zz / part.z, sigma = std::min(std::max(1e-6, noise.sigma(z)), 0.1 * z);
    RegionSums& region = region_sums_[label - 1];
    region.points += part;
    region.cells += cells;
    add_unbiased(region.weighted, part, sigma * sigma / (z * z));
}

void CellSegmenter::sum_waiting(const DepthNoise& noise) {
    std::array<PointSums, 8> sums;
    grid_.sum(waiting_, sums.data());
    for (std::size_t k = 0; k < waiting_.size(); ++k) add_sums(noise, waiting_[k].label, sums[k], 1);
    waiting_.clear();
}

void CellSegmenter::sum_regions(const CameraInfo& camera) {
    region_sums_.assign(grower_.planes().size(), {});
    waiting_.clear();
    // Whole cells in a row are weighted together, a few at a time so that their depth hardly differs.
    constexpr int kRun = 4;
    struct Run {
        PointSums sums;
        std::uint16_t label = 0;
        int cells = 0;
    } run;
    const auto end_run = [&] {
        if (run.cells > 0) add_sums(camera.noise, run.label, run.sums, run.cells);
        run = {};
    };
    for (int i = 0; i < grid_.size(); ++i) {
        const CellLabels& list = cell_labels_[i];
        const PointSums& whole = grid_.sums()[i];
        for (std::size_t k = 0; k < list.size; ++k) {
            if (list.pixels[k] == 0) continue;
            if (list.pixels[k] == whole.n) {
                if (run.label != list.label[k] || run.cells == kRun) end_run();
                run.label = list.label[k];
                run.sums += whole;
                ++run.cells;
                continue;
            }
            const CellGrid::Place place = grid_.place(i);
            waiting_.push_back({place, list.label[k], grid_.depth_at(place, candidates_[list.label[k] - 1])});
            if (waiting_.size() == 8) sum_waiting(camera.noise);
        }
    }
    end_run();
    if (!waiting_.empty()) sum_waiting(camera.noise);
}

void CellSegmenter::merge_pieces(const CameraInfo& camera) {
    // Now that the borders are final and the planes exact, pieces of one plane show that could not be told
    // before, when cells with a part of something else in them spoilt the planes.
    pieces_.clear();
    for (const RegionSums& sums : region_sums_)
        pieces_.push_back({sums.weighted, sums.weighted.fit(), sums.points.n, sums.cells, 0});
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
        const CellLabels& list = cell_labels_[i];
        if (list.size > 1) meet(list, list);
        if (i % columns + 1 < columns) meet(list, cell_labels_[i + 1]);
        if (i + columns < grid_.size()) meet(list, cell_labels_[i + columns]);
    }
    merge_regions({options_.merge_m, options_.merge_sigmas, options_.merge_angle_deg * kRadians,
                   kCellPx / camera.depth.fx, camera.noise},
                  pieces_, touching_);
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        if (pieces_[r].merged_into == 0) continue;
        const std::size_t into = root(pieces_, static_cast<std::uint16_t>(r + 1)) - 1u;
        region_sums_[into].points += region_sums_[r].points;
        region_sums_[r] = {};
    }
}

void CellSegmenter::make_regions(std::vector<PlanarRegion>& regions) {
    order_.clear();
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        if (region_sums_[r].points.n >= min_pixels_ && pieces_[r].fit.valid)
            order_.push_back(static_cast<std::uint16_t>(r));
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint16_t a, std::uint16_t b) {
        return std::pair(-region_sums_[a].points.n, a) < std::pair(-region_sums_[b].points.n, b);
    });
    new_label_.assign(region_sums_.size() + 1, 0);
    tracer_.recycle(regions);
    regions.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
        PlanarRegion& region = regions[k];
        region.plane = pieces_[order_[k]].fit.plane.plane();
        region.moments = region_sums_[order_[k]].points.moments();
        const Eigen::Vector3d& n = region.plane.normal;
        const double offset = region.plane.signed_distance(region.moments.mean());
        region.rms = std::sqrt(std::max(0.0, n.dot(region.moments.covariance() * n)) + offset * offset);
        new_label_[order_[k] + 1u] = static_cast<std::uint16_t>(k + 1);
    }
    for (std::size_t r = 0; r < pieces_.size(); ++r) {
        if (pieces_[r].merged_into != 0)
            new_label_[r + 1] = new_label_[root(pieces_, static_cast<std::uint16_t>(r + 1))];
    }
    rename_labels();
}

void CellSegmenter::rename_labels() {
    const auto stays = [&](std::uint16_t label) { return new_label_[label] == label; };
    for (int i = 0; i < grid_.size(); ++i) {
        const CellLabels& list = cell_labels_[i];
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

}  // namespace planemap
