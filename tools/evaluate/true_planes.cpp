// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/true_planes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/geometry/angle.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/same_plane.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::evaluation {

namespace {

constexpr double kSameAngle = radians(0.1), kSameDistance_m = 0.001;
constexpr std::int64_t kEvery = 5;          // frames
constexpr double kGap_m = kSamePlaneGap_m;  // between parts of one plane

bool same_plane(const Plane& a, const Plane& b, const Eigen::Vector3d& p) {
    return angle_between(a.normal, b.normal) <= kSameAngle &&
           std::abs(a.signed_distance(p) - b.signed_distance(p)) <= kSameDistance_m;
}

Eigen::Vector2d on_plane(const Pose& world_from_plane, const Eigen::Vector3d& p_world) {
    return (world_from_plane.inverse(Eigen::Isometry) * p_world).head<2>();
}

/// Gap between two boxes, cells.
double gap(const cv::Rect& a, const cv::Rect& b) {
    const int dx = std::max({0, a.x - (b.x + b.width), b.x - (a.x + a.width)});
    const int dy = std::max({0, a.y - (b.y + b.height), b.y - (a.y + a.height)});
    return std::hypot(dx, dy);
}

/// For each cell of the raster a number: which part it belongs to, parts being as far apart as the paper's
/// merging rule says: more than kGap_m between their boxes. 0 for cells that are not set.
cv::Mat1i parts_of(const PlaneRaster& raster) {
    cv::Mat1b set(raster.mask.height, raster.mask.width);
    std::copy(raster.mask.cells.begin(), raster.mask.cells.end(), set.begin());
    cv::Mat1i parts, statistics;
    cv::Mat1d centroids;
    const int count = cv::connectedComponentsWithStats(set, parts, statistics, centroids);
    std::vector<cv::Rect>
        boxes;              // of part i at i; empty for the background and for parts that went up in another
    std::vector<int> into;  // the part that each went up in, or itself
    for (int i = 0; i < count; ++i) {
        boxes.emplace_back(statistics(i, cv::CC_STAT_LEFT), statistics(i, cv::CC_STAT_TOP),
                           statistics(i, cv::CC_STAT_WIDTH), statistics(i, cv::CC_STAT_HEIGHT));
        into.push_back(i);
    }
    boxes[0] = {};
    const auto merge_one = [&] {
        for (std::size_t i = 1; i < boxes.size(); ++i) {
            for (std::size_t j = i + 1; j < boxes.size(); ++j) {
                if (boxes[i].empty() || boxes[j].empty()) continue;
                if (gap(boxes[i], boxes[j]) * PlaneRaster::kCell_m > kGap_m) continue;
                boxes[i] |= boxes[j];
                boxes[j] = {};
                std::replace(into.begin(), into.end(), static_cast<int>(j), static_cast<int>(i));
                return true;
            }
        }
        return false;
    };
    while (merge_one()) {
    }
    for (int& part : parts) part = into[static_cast<std::size_t>(part)];
    return parts;
}

/// The world as a map should hold it when a recording ends: without what is not there then, or moves.
simulator::World world_at_end(const simulator::SimulatedSource& source, std::int64_t end_us) {
    constexpr double kLeastStay_s = 1;
    simulator::World world = source.world_at(end_us);
    const double end_s = source.seconds_of(end_us);
    for (simulator::Rectangle& rectangle : world.rectangles) {
        if (rectangle.body < 0) continue;
        const auto stays = world.bodies[static_cast<std::size_t>(rectangle.body)].stays(kLeastStay_s);
        const bool stays_here = std::any_of(stays.begin(), stays.end(), [&](const auto& stay) {
            return end_s >= stay.from_s && end_s < stay.until_s;
        });
        rectangle.absent = rectangle.absent || !stays_here;
    }
    return world;
}

/// Takes from a view of another time what is not at its place at the end.
void leave_out_moved(const simulator::World& then, const simulator::World& at_end, simulator::View& view) {
    constexpr double kSamePlace_m = 1e-6;
    for (std::int16_t& index : view.rectangle.pixels) {
        if (index < 0) continue;
        const auto i = static_cast<std::size_t>(index);
        const simulator::Rectangle &a = then.rectangles[i], &b = at_end.rectangles[i];
        if (a.body < 0) continue;
        const auto before = a.corners(), after = b.corners();
        for (std::size_t corner = 0; corner < before.size() && index >= 0; ++corner) {
            if ((before[corner] - after[corner]).norm() > kSamePlace_m) index = -1;
        }
    }
}

}  // namespace

TruthCollector::TruthCollector(const simulator::World& world) {
    for (const simulator::Surface& surface : world.surfaces) surface_names_.push_back(surface.name);
    std::vector<std::vector<Eigen::Vector3d>> corners;  // of each group
    for (const simulator::Rectangle& rectangle : world.rectangles) {
        surface_of_rectangle_.push_back(static_cast<std::int16_t>(rectangle.surface));
        if (rectangle.absent || rectangle.material != simulator::Material::kMatt) {
            group_of_rectangle_.push_back(-1);
            continue;
        }
        const Plane& plane = world.surfaces[static_cast<std::size_t>(rectangle.surface)].plane;
        const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) {
            return same_plane(group.plane, plane, rectangle.centre);
        });
        const auto index = static_cast<std::size_t>(same - groups_.begin());
        if (same == groups_.end()) {
            Group& group = groups_.emplace_back();
            corners.emplace_back();
            group.plane = plane;
            group.world_from_plane = Pose::Identity();
            group.world_from_plane.linear() = plane_axes(plane.normal, rectangle.half_u);
            group.world_from_plane.translation() = plane.project(rectangle.centre);
        }
        group_of_rectangle_.push_back(static_cast<std::int16_t>(index));
        for (const Eigen::Vector3d& corner : rectangle.corners()) corners[index].push_back(corner);
    }
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        Group& group = groups_[i];
        Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
        for (const Eigen::Vector3d& corner : corners[i]) {
            const Eigen::Vector2d p = on_plane(group.world_from_plane, corner);
            low = low.cwiseMin(p), high = high.cwiseMax(p);
        }
        group.visible = PlaneRaster(low, high);
        group.material = group.visible;
        group.surfaces.assign(group.visible.mask.cells.size(), -1);
        for (std::size_t k = 0; k < corners[i].size(); k += 4) {
            Outline outline{{Ring()}};
            for (std::size_t c = 0; c < 4; ++c)
                outline.rings[0].push_back(on_plane(group.world_from_plane, corners[i][k + c]));
            for_each_cell(rasterised(outline), [&](int x, int y) {
                group.material.mask.set(x - group.material.x0, y - group.material.y0);
            });
        }
    }
}

void TruthCollector::add(const simulator::View& view, const Sight& sight) {
    for (std::size_t i = 0; i < groups_.size(); ++i)
        look(groups_[i], static_cast<std::int16_t>(i), view, sight);
}

void TruthCollector::look(Group& group, std::int16_t index, const simulator::View& view,
                          const Sight& sight) const {
    const simulator::View& v = view;
    const Pose camera_from_plane = view.world_from_camera.inverse(Eigen::Isometry) * group.world_from_plane;
    const Eigen::Vector3d eye = camera_from_plane.inverse(Eigen::Isometry).translation();  // on the plane
    const double widest = std::max(v.camera.cx, v.camera.width - 1 - v.camera.cx) / v.camera.fx;
    const double highest = std::max(v.camera.cy, v.camera.height - 1 - v.camera.cy) / v.camera.fy;
    const double reach = sight.max_m * std::hypot(1, widest, highest);
    if (eye.z() <= 0 || eye.z() >= reach) return;
    const double min_cosine = std::cos(radians(sight.max_angle_deg));
    const double around = std::sqrt(reach * reach - eye.z() * eye.z());
    const auto first = [](double p, int from) {
        return std::max(0, static_cast<int>(std::floor(p / PlaneRaster::kCell_m)) - from);
    };
    const auto last = [](double p, int from, int size) {
        return std::min(size - 1, static_cast<int>(std::ceil(p / PlaneRaster::kCell_m)) - from);
    };
    PlaneRaster& visible = group.visible;
    const int left = first(eye.x() - around, visible.x0),
              right = last(eye.x() + around, visible.x0, visible.mask.width);
    const int low = first(eye.y() - around, visible.y0),
              high = last(eye.y() + around, visible.y0, visible.mask.height);
    for (int y = low; y <= high; ++y) {
        for (int x = left; x <= right; ++x) {
            const std::size_t cell = visible.mask.index(x, y);
            if (group.material.mask.cells[cell] == 0 || visible.mask.cells[cell] != 0) continue;
            const Eigen::Vector2d middle = visible.cell_centre(x + visible.x0, y + visible.y0);
            const Eigen::Vector3d p_plane(middle.x(), middle.y(), 0);
            const Eigen::Vector3d p = camera_from_plane * p_plane;
            if (p.z() < sight.min_m || p.z() > sight.max_m) continue;
            if (eye.z() < min_cosine * p.norm()) continue;
            const Eigen::Vector2d pixel = v.camera.project(p);
            if (!v.camera.sees(pixel)) continue;
            const int rectangle = v.rectangle(static_cast<int>(std::lround(pixel.x())),
                                              static_cast<int>(std::lround(pixel.y())));
            if (rectangle < 0 || group_of_rectangle_[static_cast<std::size_t>(rectangle)] != index) continue;
            visible.mask.cells[cell] = 1;
            group.surfaces[cell] = surface_of_rectangle_[static_cast<std::size_t>(rectangle)];
        }
    }
}

std::vector<TruePlane> TruthCollector::planes() const {
    std::vector<TruePlane> planes;
    for (const Group& group : groups_) {
        if (group.visible.count() == 0) continue;
        const cv::Mat1i parts = parts_of(group.visible);
        std::map<int, TruePlane> by_part;
        std::map<int, std::map<std::int16_t, int>> surfaces;  // cells of each, by part
        for_each_cell(group.visible, [&](int x, int y) {
            const int column = x - group.visible.x0, row = y - group.visible.y0, part = parts(row, column);
            TruePlane& plane = by_part[part];
            if (plane.visible.mask.cells.empty()) {
                plane.plane = group.plane;
                plane.world_from_plane = group.world_from_plane;
                plane.visible = group.visible;
                plane.material = group.material;
                std::fill(plane.visible.mask.cells.begin(), plane.visible.mask.cells.end(), std::uint8_t{0});
            }
            plane.visible.mask.set(column, row);
            ++surfaces[part][group.surfaces[group.visible.mask.index(column, row)]];
        });
        const auto first = planes.size();
        for (auto& [part, plane] : by_part) {
            const auto& names = surfaces.at(part);
            const auto most = std::max_element(
                names.begin(), names.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
            plane.name = surface_names_[static_cast<std::size_t>(most->first)];
            if (names.size() > 1) plane.name.append("+").append(std::to_string(names.size() - 1));
            planes.push_back(std::move(plane));
        }
        std::stable_sort(planes.begin() + static_cast<std::ptrdiff_t>(first), planes.end(),
                         [](const auto& a, const auto& b) { return a.visible.count() > b.visible.count(); });
    }
    return planes;
}

std::optional<std::vector<TruePlane>> true_planes(const std::string& input, std::int64_t frames) {
    if (!input.starts_with("sim:")) return std::nullopt;
    const simulator::SimulatedSource source(simulator::parse_simulator_name(input));
    Sight sight;
    sight.min_m = source.camera().depth_min_m;
    sight.max_m = source.camera().depth_max_m;
    sight.max_angle_deg = simulator::DepthSensorOptions().grazing_from_deg;
    const auto all = static_cast<std::int64_t>(*source.size());
    const std::int64_t count = frames > 0 ? std::min(frames, all) : all;
    const simulator::World at_end = world_at_end(source, source.utime(static_cast<std::size_t>(count - 1)));
    TruthCollector truth(at_end);
    for (std::int64_t i = 0; i < count; i += kEvery) {
        const auto index = static_cast<std::size_t>(i);
        simulator::View view = source.depth_view(index);
        if (!at_end.bodies.empty()) leave_out_moved(source.world_at(source.utime(index)), at_end, view);
        truth.add(view, sight);
    }
    return truth.planes();
}

}  // namespace planemap::evaluation
