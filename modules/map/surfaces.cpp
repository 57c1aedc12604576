// SPDX-License-Identifier: BSD-3-Clause
#include "map/surfaces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <set>

#include "core/geometry/outline_frame.hpp"
#include "map/evidence_shape.hpp"
#include "map/options.hpp"

namespace planemap::map {

namespace {

constexpr double kCell_m = 0.05;    // of the rasters that shapes are compared on
constexpr double kHopeless = 1.5;   // times what may be, between planes where their boxes overlap
constexpr double kMostCells = 4e6;  // of one of them: beyond, its cells are coarser
/// How the shape of what a plane brought along without regions is read. It is drawn in cells of kCell_m and
/// counted, not shown: nearer to what was seen than a cell is near enough, whatever outlines are asked for.
constexpr double kShapeTolerance_m = 0.03;
const OutlineOptions kShape{MapOptions::outline_min_support, 0.01, kShapeTolerance_m, 0};

/// How far a plane's views may be off along its normal by what depth errs.
struct DepthError {
    double variance = 0, bias = 0;  ///< sums, weighted by readings
    double weight = 0;

    void add(const StoredRegion& region, const DepthNoise& noise, double range_bias) {
        const double count = static_cast<double>(region.count), z = mean_depth(region);
        variance += count * noise.sigma(z) * noise.sigma(z);
        bias += count * range_bias * z;
        weight += count;
    }
};

/// A rectangle of cells on a plane.
struct Raster {
    Pose frame_from_world = Pose::Identity();
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    double cell_m = kCell_m;
    int columns = 0, rows = 0;

    Eigen::Vector2d centre(int x, int y) const { return low + cell_m * Eigen::Vector2d(x + 0.5, y + 0.5); }
};

void add_to(Bitmap& shape, Bitmap& scratch, const FlatPolygon& polygon, const Raster& raster) {
    scratch.reset(0, 0, shape.words(), shape.rows());
    scratch.draw(polygon, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d {
        return (v - raster.low) / raster.cell_m - Eigen::Vector2d::Constant(0.5);
    });
    shape |= scratch;
}

class SurfaceUnion {
  public:
    SurfaceUnion(PlaneSet& planes, std::vector<SeenRegion>& seen, const SurfaceRules& rules)
        : planes_(planes), seen_(seen), rules_(rules), regions_of_(planes.estimates().size()) {
        errors_.resize(planes.estimates().size());
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const SeenRegion& region = seen[i];
            if (region.plane == PlaneSet::none()) continue;
            regions_of_[region.plane].push_back(i);
            errors_[region.plane].add(region.stored(), region.keyframe->noise, rules.range_bias);
        }
    }

    std::vector<std::size_t> run() {
        std::vector<std::size_t> all(planes_.estimates().size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
        std::vector<std::size_t> now = planes_.merge(
            all, rules_.angle_rad, [this](std::size_t a, std::size_t b) { return misfit(a, b); },
            [this](std::size_t into, std::size_t from) { joined(into, from); });
        for (SeenRegion& region : seen_)
            if (region.plane != PlaneSet::none()) region.plane = now[region.plane];
        return now;
    }

  private:
    /// How far two planes are apart, of what they may be; nothing if they are two surfaces.
    std::optional<double> misfit(std::size_t a, std::size_t b) {
        const PlaneEstimate &plane_a = planes_.estimates()[a], &plane_b = planes_.estimates()[b];
        const RegionRelation relation = relate(plane_a.plane, plane_a.box, plane_b.plane, plane_b.box);
        if (relation.gap_m > 0 || relation.distance_m > kHopeless * rules_.most_apart_full_m)
            return std::nullopt;
        const std::optional<Overlap> overlap = overlap_of(a, b);
        if (!overlap) return std::nullopt;
        const bool full = overlap->share >= rules_.full_overlap;
        const double most = std::min(full ? rules_.most_apart_full_m : rules_.most_apart_m, tolerance(a, b));
        if (overlap->apart_m > most) return std::nullopt;
        const bool is_told_by_overlap = full && overlap->apart_m <= rules_.most_apart_m;
        if (!is_told_by_overlap && are_seen_as_two(a, b)) return std::nullopt;
        return overlap->apart_m / most;
    }

    /// How far apart what poses and depth err puts them.
    double tolerance(std::size_t a, std::size_t b) const {
        double variance = 2 * rules_.pose_sigma_m * rules_.pose_sigma_m, bias = 0;
        for (const DepthError* error : {&errors_[a], &errors_[b]}) {
            if (error->weight <= 0) continue;
            variance += error->variance / error->weight;
            bias += error->bias / error->weight;
        }
        return rules_.sigmas * std::sqrt(variance) + bias;
    }

    struct Overlap {
        double share = 0;    ///< of the smaller shape
        double apart_m = 0;  ///< RMS
    };
    /// Where both planes' shapes are; nothing if that is little.
    std::optional<Overlap> overlap_of(std::size_t a, std::size_t b) {
        const PlaneEstimate &plane_a = planes_.estimates()[a], &plane_b = planes_.estimates()[b];
        const std::optional<Raster> raster = common_raster(plane_a, plane_b);
        if (!raster) return std::nullopt;
        Bitmap both = shape(a, *raster);
        const Bitmap shape_b = shape(b, *raster);
        both &= shape_b;
        const double cell = raster->cell_m * raster->cell_m;
        const double smaller = std::min(area(a), area(b));
        const double overlap = static_cast<double>(both.count()) * cell;
        if (overlap < 4 * cell || overlap < rules_.least_overlap * smaller) return std::nullopt;
        const Plane other = raster->frame_from_world * plane_b.plane;
        double sum = 0;
        for (int y = 0; y < raster->rows; ++y) {
            for (int w = 0; w < both.words(); ++w) {
                for (std::uint64_t bits = both.row(y)[w]; bits != 0; bits &= bits - 1) {
                    const Eigen::Vector2d p = raster->centre(64 * w + std::countr_zero(bits), y);
                    const double distance = other.signed_distance({p.x(), p.y(), 0});
                    sum += distance * distance;
                }
            }
        }
        return Overlap{overlap / smaller, std::sqrt(sum * cell / overlap)};
    }

    /// Over what both boxes cover, in the frame of a's box.
    static std::optional<Raster> common_raster(const PlaneEstimate& a, const PlaneEstimate& b) {
        Raster raster;
        raster.frame_from_world = a.box.frame_from_box.inverse(Eigen::Isometry);
        Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
        for (const Eigen::Vector3d& corner : b.box.face()) {
            const Eigen::Vector2d p = (raster.frame_from_world * corner).head<2>();
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        low = low.cwiseMax(-a.box.half_extents.head<2>());
        high = high.cwiseMin(a.box.half_extents.head<2>());
        const Eigen::Vector2d size = high - low;
        if (!(size.minCoeff() > 0)) return std::nullopt;
        raster.low = low;
        raster.cell_m = std::max(kCell_m, std::sqrt(size.prod() / kMostCells));
        raster.columns = static_cast<int>(std::ceil(size.x() / raster.cell_m));
        raster.rows = static_cast<int>(std::ceil(size.y() / raster.cell_m));
        return raster;
    }

    /// All regions of a plane, and what it brought along without regions.
    Bitmap shape(std::size_t plane, const Raster& raster) {
        Bitmap shape(0, 0, (raster.columns + 63) / 64, raster.rows);
        for (const std::size_t i : regions_of_[plane]) {
            const SeenRegion& seen = seen_[i];
            outline_in(raster.frame_from_world * seen.world_from_box, seen.stored(), *seen.keyframe,
                       polygon_);
            add_to(shape, scratch_, polygon_, raster);
        }
        const EvidenceGrid& grid = planes_.estimates()[plane].grid;
        if (grid.empty()) return shape;
        const Pose frame_from_grid = raster.frame_from_world * grid.world_from_grid();
        polygon_.assign(projected(frame_from_grid, outline_of(grid, kShape)));
        add_to(shape, scratch_, polygon_, raster);
        return shape;
    }

    /// Of a plane's shape; its own raster is drawn once.
    double area(std::size_t plane) {
        const auto known = areas_.find(plane);
        if (known != areas_.end()) return known->second;
        const PlaneEstimate& estimate = planes_.estimates()[plane];
        const std::optional<Raster> raster = common_raster(estimate, estimate);
        const double area =
            raster ? static_cast<double>(shape(plane, *raster).count()) * raster->cell_m * raster->cell_m : 0;
        return areas_[plane] = area;
    }

    /// Views that see a region of either, side by side and with a step between them.
    bool are_seen_as_two(std::size_t a, std::size_t b) const {
        std::multimap<int, std::size_t> of_a;
        for (const std::size_t i : regions_of_[a]) of_a.emplace(seen_[i].keyframe_id, i);
        std::set<int> stepping, of_b;
        for (const std::size_t j : regions_of_[b]) {
            of_b.insert(seen_[j].keyframe_id);
            const auto [from, to] = of_a.equal_range(seen_[j].keyframe_id);
            for (auto at = from; at != to; ++at)
                if (seen_[at->second].keyframe == seen_[j].keyframe && is_step(seen_[at->second], seen_[j]))
                    stepping.insert(seen_[j].keyframe_id);
        }
        std::set<int> keyframes_a;
        for (const auto& [id, i] : of_a) keyframes_a.insert(id);
        const auto fewest = static_cast<int>(std::min(keyframes_a.size(), of_b.size()));
        return static_cast<int>(stepping.size()) >= std::clamp(fewest / 2, 1, rules_.least_views);
    }

    bool is_step(const SeenRegion& a, const SeenRegion& b) const {
        const PlacedRegion one(Pose::Identity(), a.stored()), other(Pose::Identity(), b.stored());
        const RegionRelation relation = relate(one.plane, one.box, other.plane, other.box);
        if (relation.gap_m > rules_.beside_m) return false;
        const double z = std::max(mean_depth(a.stored()), mean_depth(b.stored()));
        const double noise = a.keyframe->noise.sigma(z);
        return relation.distance_m > rules_.sigmas * noise + rules_.range_bias * z;
    }

    void joined(std::size_t into, std::size_t from) {
        std::vector<std::size_t>& regions = regions_of_[into];
        regions.insert(regions.end(), regions_of_[from].begin(), regions_of_[from].end());
        regions_of_[from].clear();
        errors_[into].variance += errors_[from].variance;
        errors_[into].bias += errors_[from].bias;
        errors_[into].weight += errors_[from].weight;
        areas_.erase(into);
    }

    PlaneSet& planes_;
    std::vector<SeenRegion>& seen_;
    SurfaceRules rules_;
    std::vector<std::vector<std::size_t>> regions_of_;  ///< by plane: indices of seen_
    std::vector<DepthError> errors_;                    ///< by plane
    std::map<std::size_t, double> areas_;
    FlatPolygon polygon_;
    Bitmap scratch_;
};

}  // namespace

std::vector<std::size_t> unite_surfaces(PlaneSet& planes, std::vector<SeenRegion>& seen,
                                        const SurfaceRules& rules) {
    return SurfaceUnion(planes, seen, rules).run();
}

}  // namespace planemap::map
