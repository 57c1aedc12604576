// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/soundness.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/geometry/angle.hpp"
#include "evaluate/edge_judge.hpp"
#include "evaluate/map_faces.hpp"
#include "evaluate/statistics.hpp"

namespace planemap::evaluation {

namespace {

constexpr double kCell_m = PlaneRaster::kCell_m;
constexpr double kSigmas = 2;    // of a reading on one of two surfaces,
constexpr double kApart = 6;     // and of two that noise cannot take for each other
constexpr int kLeastSteps = 10;  // from one to the other in one view
constexpr int kStep_px = 2;      // at most, of a thinned view

/// Two planes that may be one surface, the smaller first.
struct Pair {
    std::size_t small = 0, large = 0;
    std::vector<Eigen::Vector2i> cells;  ///< of the smaller one, on the larger one
    int views = 0;                       ///< that see both side by side
    Image<std::uint8_t> on;  ///< of the view at hand: 1, 2: the reading is on the smaller, larger one
};

std::vector<Eigen::Vector2i> common_cells(const MapFace& small, const MapFace& large, double reach_m) {
    std::vector<Eigen::Vector2i> cells;
    for_each_cell(small.raster, [&](int x, int y) {
        const Eigen::Vector2d middle = small.raster.cell_centre(x, y);
        const Eigen::Vector3d p = small.world_from_plane * Eigen::Vector3d(middle.x(), middle.y(), 0);
        if (std::abs(large.plane.signed_distance(p)) <= reach_m && large.covers(p)) cells.emplace_back(x, y);
    });
    return cells;
}

std::vector<Pair> pairs_of(const std::vector<MapFace>& faces, const SoundnessLimits& limits) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t j = i + 1; j < faces.size(); ++j) {
            if (degrees(angle_between(faces[i].plane.normal, faces[j].plane.normal)) > limits.doubled_deg)
                continue;
            const double apart =
                (faces[i].world_from_plane.translation() - faces[j].world_from_plane.translation()).norm();
            if (apart > faces[i].reach + faces[j].reach + limits.doubled_m) continue;
            Pair pair;
            pair.small = i, pair.large = j;
            if (faces[i].raster.count() > faces[j].raster.count()) std::swap(pair.small, pair.large);
            pair.cells = common_cells(faces[pair.small], faces[pair.large], limits.doubled_m);
            if (!pair.cells.empty()) pairs.push_back(std::move(pair));
        }
    }
    return pairs;
}

/// Sums of residuals.
struct Sums {
    std::int64_t count = 0;
    double sum = 0, squares = 0;

    void add(double residual) {
        ++count;
        sum += residual;
        squares += residual * residual;
    }
    Residuals residuals() const {
        if (count == 0) return {};
        const auto n = static_cast<double>(count);
        return {count, sum / n, std::sqrt(squares / n)};
    }
};

/// Goes through the readings of all views.
class Readings {
  public:
    Readings(const std::vector<MapFace>& faces, std::vector<Pair>& pairs, const SoundnessLimits& limits,
             const ReadingListener& listener)
        : faces_(faces), pairs_(pairs), limits_(limits), listener_(listener), of_planes_(faces.size()) {}

    void add(const PosedView& posed) {
        const DepthView& view = *posed.view;
        const Pose world_from_depth = posed.world_from_color * view.color_from_depth;
        for (Pair& pair : pairs_) pair.on = Image<std::uint8_t>(view.metres.width, view.metres.height);
        for (int v = 0; v < view.metres.height; ++v) {
            for (int u = 0; u < view.metres.width; ++u) {
                const double z = static_cast<double>(view.metres(u, v));
                if (z == 0) continue;
                const Eigen::Vector3d p = world_from_depth * view.camera.unproject(u, v, z);
                const double sigma = view.noise.sigma(z);
                explain({p, view.colors(u, v), z}, sigma);
                tell_apart(u, v, p, sigma);
            }
        }
        for (Pair& pair : pairs_) pair.views += steps(pair.on) >= kLeastSteps;
    }

    void report(Soundness& soundness) const {
        for (std::size_t i = 0; i < of_planes_.size(); ++i)
            soundness.planes[i].residuals = of_planes_[i].residuals();
        for (const auto& [metre, range] : by_range_) {
            soundness.by_range.push_back(
                {metre * 1.0, metre + 1.0, range.counts, range.explained.residuals()});
            soundness.counts += range.counts;
        }
        soundness.residuals = all_.residuals();
    }

  private:
    struct Range {
        ReadingCounts counts;
        Sums explained;
    };

    void explain(JudgedReading reading, double sigma) {
        const double band = limits_.band_m(sigma);
        const auto nearest = nearest_face(faces_, reading.p_world, std::max(band, limits_.near_m));
        Range& range = by_range_[static_cast<int>(std::floor(reading.range_m))];
        ++range.counts.readings;
        if (nearest) {
            const double distance = std::abs(nearest->distance_m);
            reading.face = &faces_[nearest->index];
            reading.distance_m = nearest->distance_m;
            reading.is_explained = distance <= band;
            reading.is_near = distance <= limits_.near_m;
            range.counts.close += distance <= limits_.close_m;
            range.counts.near += reading.is_near;
        }
        if (reading.is_explained) {
            ++range.counts.explained;
            all_.add(reading.distance_m);
            of_planes_[nearest->index].add(reading.distance_m);
            range.explained.add(reading.distance_m);
        }
        if (listener_) listener_(reading);
    }

    void tell_apart(int u, int v, const Eigen::Vector3d& p, double sigma) {
        for (Pair& pair : pairs_) {
            if (pair.views >= limits_.least_views) continue;
            const MapFace &small = faces_[pair.small], &large = faces_[pair.large];
            const double to_small = small.plane.signed_distance(p), to_large = large.plane.signed_distance(p);
            if (std::abs(to_small - to_large) < kApart * sigma) continue;
            if (std::abs(to_small) <= kSigmas * sigma && small.covers(p)) pair.on(u, v) = 1;
            if (std::abs(to_large) <= kSigmas * sigma && large.covers(p)) pair.on(u, v) = 2;
        }
    }

    /// Places where a reading on one surface stands beside one on the other.
    static int steps(const Image<std::uint8_t>& on) {
        int count = 0;
        for (int v = 0; v < on.height; ++v) {
            for (int u = 0; u < on.width; ++u) {
                if (on(u, v) == 0) continue;
                const int other = 3 - on(u, v);
                for (int step = 1; step <= kStep_px; ++step) {
                    count += u + step < on.width && on(u + step, v) == other;
                    count += v + step < on.height && on(u, v + step) == other;
                }
            }
        }
        return count;
    }

    const std::vector<MapFace>& faces_;
    std::vector<Pair>& pairs_;
    const SoundnessLimits& limits_;
    const ReadingListener& listener_;
    Sums all_;
    std::vector<Sums> of_planes_;
    std::map<int, Range> by_range_;  ///< by the metre
};

/// Free space: which of a plane's cells the views see, which of these they have seen through to something
/// behind, and which they have a reading of.
void check_free_space(const MapFace& face, const std::vector<PosedView>& views, const SoundnessLimits& limits,
                      PlaneSoundness& verdict) {
    struct Looks {
        std::uint16_t seen = 0, behind = 0, on_it = 0;
    };
    std::vector<Looks> looks(face.raster.mask.cells.size());
    for (const PosedView& posed : views) {
        const DepthView& view = *posed.view;
        const Pose depth_from_world =
            (posed.world_from_color * view.color_from_depth).inverse(Eigen::Isometry);
        const Pose depth_from_plane = depth_from_world * face.world_from_plane;
        const Plane plane = depth_from_world * face.plane;
        if (plane.d <= 0) continue;  // seen from behind
        for_each_cell(face.raster, [&](int x, int y) {
            const Eigen::Vector2d middle = face.raster.cell_centre(x, y);
            const Eigen::Vector3d p = depth_from_plane * Eigen::Vector3d(middle.x(), middle.y(), 0);
            if (p.z() <= 0) return;
            const Eigen::Vector2d pixel = view.camera.project(p);
            if (!view.camera.sees(pixel)) return;
            const int u = static_cast<int>(std::lround(pixel.x())),
                      v = static_cast<int>(std::lround(pixel.y()));
            const double z = static_cast<double>(view.metres(u, v));
            if (z == 0) return;
            Looks& look = looks[face.raster.mask.index(x - face.raster.x0, y - face.raster.y0)];
            ++look.seen;
            const double before = plane.signed_distance(view.camera.unproject(u, v, z));
            look.behind +=
                -before > std::max(limits.behind_m, limits.behind_sigmas * view.noise.sigma(p.z()));
            look.on_it += std::abs(before) <= limits.band_m(view.noise.sigma(z));
        });
    }
    for (const Looks& look : looks) {
        verdict.seen_m2 += look.seen > 0 ? PlaneRaster::kCellArea_m2 : 0;
        verdict.floating_m2 += 2 * look.behind > look.seen ? PlaneRaster::kCellArea_m2 : 0;
        verdict.confirmed_m2 += look.on_it > 0 ? PlaneRaster::kCellArea_m2 : 0;
    }
}

/// Area of the cells of the smaller outlines that another plane says again; each cell once.
double doubled_area(const std::vector<MapFace>& faces, const std::vector<Pair>& pairs,
                    const SoundnessLimits& limits) {
    std::vector<std::vector<std::uint8_t>> doubled(faces.size());
    std::size_t count = 0;
    for (const Pair& pair : pairs) {
        if (pair.views >= limits.least_views) continue;
        const PlaneRaster& raster = faces[pair.small].raster;
        auto& cells = doubled[pair.small];
        cells.resize(raster.mask.cells.size());
        for (const Eigen::Vector2i& cell : pair.cells) {
            std::uint8_t& is = cells[raster.mask.index(cell.x() - raster.x0, cell.y() - raster.y0)];
            count += is == 0;
            is = 1;
        }
    }
    return static_cast<double>(count) * PlaneRaster::kCellArea_m2;
}

}  // namespace

std::optional<double> Soundness::doubled_share() const {
    return share(doubled_m2, area_m2);
}
std::optional<double> Soundness::floating_share() const {
    return share(floating_m2, seen_m2);
}
std::optional<double> Soundness::confirmed_share() const {
    return share(confirmed_m2, area_m2);
}

std::optional<double> ReadingCounts::share_of(std::int64_t ReadingCounts::*count) const {
    return share(static_cast<double>(this->*count), static_cast<double>(readings));
}
void ReadingCounts::operator+=(const ReadingCounts& other) {
    for (const auto count :
         {&ReadingCounts::readings, &ReadingCounts::close, &ReadingCounts::explained, &ReadingCounts::near})
        this->*count += other.*count;
}

double SoundnessLimits::band_m(double sigma_m) const {
    return std::max(explained_m, explained_sigmas * sigma_m);
}

Soundness soundness(const PlaneMap& map, const std::vector<PosedView>& views, const SoundnessLimits& limits,
                    const ReadingListener& listener) {
    const std::vector<MapFace> faces = faces_of(map);
    std::vector<Pair> pairs = pairs_of(faces, limits);
    Soundness result;
    result.views = views.size();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        PlaneSoundness& verdict = result.planes.emplace_back();
        verdict.id = map.planes[i].id;
        verdict.area_m2 = faces[i].raster.area();
        check_free_space(faces[i], views, limits, verdict);
        result.area_m2 += verdict.area_m2;
        result.seen_m2 += verdict.seen_m2;
        result.floating_m2 += verdict.floating_m2;
        result.confirmed_m2 += verdict.confirmed_m2;
    }
    Readings readings(faces, pairs, limits, listener);
    for (const PosedView& view : views) readings.add(view);
    readings.report(result);
    result.doubled_m2 = doubled_area(faces, pairs, limits);
    for (const Pair& pair : pairs) {
        if (pair.views >= limits.least_views) continue;
        result.doubled.push_back({map.planes[pair.small].id, map.planes[pair.large].id,
                                  static_cast<double>(pair.cells.size()) * PlaneRaster::kCellArea_m2});
    }
    std::stable_sort(result.doubled.begin(), result.doubled.end(),
                     [](const auto& a, const auto& b) { return a.area_m2 > b.area_m2; });
    result.outline_gaps = outline_gaps(map);
    return result;
}

}  // namespace planemap::evaluation
