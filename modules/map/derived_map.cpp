// SPDX-License-Identifier: BSD-3-Clause
#include "map/derived_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/angle.hpp"
#include "map/labels.hpp"

namespace planemap::map {

namespace {

constexpr const char* kByEarlier = "by the map to start from";
/// Cosine of 30 deg: so far from what planes and motion say, what was told is doubted aloud.
constexpr double kContradicts = 0.866;

/// So many of the poses or a few more, spread over all: they tell which way is up as well as all do.
std::vector<Pose> some_of(const std::map<int, Pose>& poses) {
    constexpr std::size_t kCameras = 128;
    const std::size_t stride = 1 + poses.size() / kCameras;
    std::vector<Pose> cameras;
    std::size_t i = 0;
    for (const auto& [id, pose] : poses) {
        if (i++ % stride == 0) cameras.push_back(pose);
    }
    return cameras;
}

/// True for lines of which no end moved to note.
bool are_alike(const std::vector<Meeting>& a, const std::vector<Meeting>& b) {
    constexpr float kMoved_m = 0.005F;
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Meeting& x, const Meeting& y) {
        return x.line.plane_a == y.line.plane_a && x.line.plane_b == y.line.plane_b &&
               (x.line.from - y.line.from).norm() <= kMoved_m && (x.line.to - y.line.to).norm() <= kMoved_m;
    });
}

}  // namespace

void DerivedMap::start_from(const PlaneMap& map) {
    map_.utime = map.utime;
    map_.up = map.up;
    earlier_up_ = map.up;
    if (!map.up.isZero()) why_up_ = kByEarlier;
    inferred_.start_from(map);
}

void DerivedMap::take_labels(const PlaneMap& earlier) {
    for (MapPlane& plane : map_.planes) {
        if (const MapPlane* before = earlier.find(plane.id)) plane.label = before->label;
    }
}

void DerivedMap::seen_at(std::int64_t utime) {
    map_.utime = std::max(map_.utime, utime);
}

/// Returns whether the plane changed to note; it has then its outline as exact as its cells, for others to be
/// compared with.
bool DerivedMap::derive(PlaneEstimate& estimate, std::optional<MapPlane>& plane) const {
    if (plane) {
        const Plane* as_drawn = intersections_.plane(estimate.id);
        if (keeps_outline(estimate, *plane, as_drawn != nullptr ? *as_drawn : plane->plane())) {
            move_to_estimate(*plane, estimate);
            return false;
        }
    }
    estimate.changed_cells = 0;
    plane = derived_plane(estimate, derivation_);
    return true;
}

/// Finds up, by the best that says it, and labels all planes.
void DerivedMap::label(const std::map<int, Pose>& poses, const ToldUp& told) {
    const std::vector<Pose> cameras = some_of(poses);
    if (cameras.empty()) return;
    const LabelRules rules;
    Up up = told.find(poses, map_.planes, rules.gravity);
    Up found = find_up(map_.planes, cameras, rules.gravity);
    if (!up.direction) {
        if (!found.direction && !earlier_up_.isZero()) found = {earlier_up_.cast<double>(), kByEarlier};
        up = {found.direction, (up.why.empty() ? "" : up.why + "; ") + found.why};
    } else if (found.direction && up.direction->dot(*found.direction) < kContradicts) {
        up.why += "; planes and motion say another direction, " +
                  std::to_string(std::lround(degrees(angle_between(*up.direction, *found.direction)))) +
                  " deg off: is that how it is mounted?";
    }
    label_planes(map_, up, cameras, rules);
    why_up_ = up.why;
    told_revision_ = told.revision();
    told_poses_ = poses.size();
}

/// Where each plane meets others, by its id.
std::map<int, std::vector<Meeting>> DerivedMap::meetings() const {
    std::map<int, std::vector<Meeting>> meetings;
    for (const IntersectionLine& line : intersections_.meetings()) {
        const MapPlane *a = map_.find(line.plane_a), *b = map_.find(line.plane_b);
        const auto sine = static_cast<double>(a->normal.cross(b->normal).norm());
        const Meeting meeting{
            line, meeting_reach(static_cast<double>(a->rms), static_cast<double>(b->rms), sine, adjacency_)};
        meetings[line.plane_a].push_back(meeting);
        meetings[line.plane_b].push_back(meeting);
    }
    return meetings;
}

/// Lays the outlines of planes that changed, or whose lines did, on these; returns which, ascending.
std::vector<int> DerivedMap::end_at_lines(const std::vector<PlaneEstimate>& estimates,
                                          const std::vector<int>& changed) {
    std::vector<int> laid;
    std::map<int, std::vector<Meeting>> meetings = this->meetings();
    for (const PlaneEstimate& estimate : estimates) {
        const auto plane = std::lower_bound(map_.planes.begin(), map_.planes.end(), estimate.id,
                                            [](const MapPlane& p, int id) { return p.id < id; });
        if (plane == map_.planes.end() || plane->id != estimate.id) continue;
        const std::vector<Meeting>& now = meetings[estimate.id];
        if (!std::binary_search(changed.begin(), changed.end(), estimate.id) &&
            are_alike(now, met_[estimate.id]))
            continue;
        if (auto ended = ended_plane(estimate, derivation_, now)) {
            ended->label = plane->label;
            *plane = std::move(*ended);
        }
        met_[estimate.id] = now;
        laid.push_back(estimate.id);
    }
    std::erase_if(met_, [&](const auto& of) { return map_.find(of.first) == nullptr; });
    std::sort(laid.begin(), laid.end());
    return laid;
}

void DerivedMap::refresh(std::vector<PlaneEstimate>& estimates, const std::map<int, Pose>& poses,
                         const ToldUp& told) {
    std::map<int, MapPlane> before;
    for (MapPlane& plane : map_.planes) before.emplace(plane.id, std::move(plane));
    std::vector<int> changed;
    std::vector<MapPlane> planes;
    for (PlaneEstimate& estimate : estimates) {
        std::optional<MapPlane> plane;
        if (const auto known = before.find(estimate.id); known != before.end()) {
            plane = std::move(known->second);
            before.erase(known);
        }
        if (estimate.changed) {
            estimate.changed = false;
            if (derive(estimate, plane)) changed.push_back(estimate.id);
        }
        if (plane) planes.push_back(std::move(*plane));
    }
    for (const auto& [id, plane] : before) changed.push_back(id);  // merged into another one, or gone
    std::sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.id < b.id; });
    planes.shrink_to_fit();
    map_.planes = std::move(planes);
    std::sort(changed.begin(), changed.end());
    intersections_.update(map_, changed);
    const std::vector<int> laid = end_at_lines(estimates, changed);
    const bool more_is_told =
        told.revision() != told_revision_ || (told.revision() > 0 && poses.size() != told_poses_);
    if (!changed.empty() || more_is_told) label(poses, told);
    if (!laid.empty() || !changed.empty()) inferred_.update(map_, laid);
}

}  // namespace planemap::map
