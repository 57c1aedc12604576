// SPDX-License-Identifier: BSD-3-Clause
#include "report/world_frames.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "evaluate/statistics.hpp"
#include "run/report_text.hpp"

namespace planemap {

namespace {

constexpr std::size_t kFewestPoses = 10;
constexpr double kMostApart_m = 0.1, kMostTurned_deg = 3;
constexpr double kLeastArea = 0.5;
constexpr double kLeastSpread = 0.02;  ///< of the normals' smallest direction, as a share of area

struct PoseDifference {
    double metres = 0, angle_deg = 0;
};

/// Of the poses that both have for the same microsecond.
std::vector<PoseDifference> differences(const Trajectory& a, const Trajectory& b) {
    std::vector<PoseDifference> all;
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
        if (a[i].utime < b[k].utime) {
            ++i;
        } else if (b[k].utime < a[i].utime) {
            ++k;
        } else {
            const Pose a_from_b = a[i++].world_from_camera * b[k++].world_from_camera.inverse();
            const Eigen::Vector3d apart =
                a[i - 1].world_from_camera.translation() - b[k - 1].world_from_camera.translation();
            all.push_back({apart.norm(), degrees(rotation_angle(a_from_b))});
        }
    }
    return all;
}

double area_of(const PlaneMap& map) {
    double area = 0;
    for (const MapPlane& plane : map.planes) area += static_cast<double>(plane.area);
    return area;
}

WorldFrames by_planes(const PlaneMap& map_a, const PlaneMap& map_b, const evaluation::PlaneMatches& matches) {
    double in_place = 0;
    Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
    for (const evaluation::PlaneMatch& pair : matches.pairs) {
        const MapPlane *a = map_a.find(pair.a), *b = map_b.find(pair.b);
        if (a == nullptr || b == nullptr || !pair.is_in_place()) continue;
        const double area = static_cast<double>(std::min(a->area, b->area));
        const Eigen::Vector3d n = a->normal.cast<double>();
        in_place += area;
        directions += area * n * n.transpose();
    }
    const double smaller = std::min(area_of(map_a), area_of(map_b));
    const double share = smaller > 0 ? in_place / smaller : 0;
    const double spread =
        in_place > 0 ? Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(directions / in_place).eigenvalues()[0]
                     : 0;
    const std::string text =
        format("%.0f %% of the smaller map's area is in place in the other", 100 * share);
    if (share >= kLeastArea && spread >= kLeastSpread) return {true, text};
    return {false, "no poses of the same moments tie them, and " + text +
                       (share >= kLeastArea ? ", but not in three directions" : "")};
}

}  // namespace

WorldFrames compare_world_frames(const PlaneMap& map_a, const Trajectory& a, const PlaneMap& map_b,
                                 const Trajectory& b, const evaluation::PlaneMatches& matches) {
    const std::vector<PoseDifference> shared = differences(a, b);
    if (shared.size() < kFewestPoses) return by_planes(map_a, map_b, matches);
    std::vector<double> metres, angles_deg;
    for (const PoseDifference& difference : shared) {
        metres.push_back(difference.metres);
        angles_deg.push_back(difference.angle_deg);
    }
    const double apart = statistics(metres).median, turned = statistics(angles_deg).median;
    return {apart <= kMostApart_m && turned <= kMostTurned_deg,
            std::to_string(shared.size()) + " poses of the same moments are " + format("%.3f m", apart) +
                " and " + format("%.2f deg", turned) + " apart (medians)"};
}

}  // namespace planemap
