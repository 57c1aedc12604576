// SPDX-License-Identifier: BSD-3-Clause
#include "map/gravity.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/angle.hpp"
#include "map/handling.hpp"
#include "map/room_view.hpp"

namespace planemap::map {

namespace {

constexpr std::size_t kNormals = 16, kPairs = 8;  // large planes that answers are made of
constexpr double kSame_deg = 3;                   // answers nearer than that are one
constexpr int kRefinements = 4;
constexpr double kPlanesOdds = 10, kFacingOdds = 2, kHangingOdds = 3, kLowOdds = 2;
constexpr double kToldWeight = 0.05;  // of what was told, or of the answer, beside the planes: it decides
                                      // what the planes leave open

/// Directions that may be up, each with its opposite.
std::vector<Eigen::Vector3d> answers(const RoomView& room, const Handling& handling) {
    std::vector<Eigen::Vector3d> found;
    const double same = std::cos(radians(kSame_deg));
    const auto add = [&](const Eigen::Vector3d& direction) {
        const double length = direction.norm();
        if (length < 0.2) return;  // badly determined
        for (const double sign : {1.0, -1.0}) {
            const Eigen::Vector3d u = sign / length * direction;
            if (std::none_of(found.begin(), found.end(), [&](const auto& f) { return f.dot(u) > same; }))
                found.push_back(u);
        }
    };
    const std::span<const RoomView::Seen> planes = room.planes();
    const std::array<Eigen::Vector3d, 2> image{handling.image_down(), handling.image_right()};
    for (std::size_t i = 0; i < std::min(planes.size(), kNormals); ++i) add(planes[i].normal);
    for (std::size_t i = 0; i < std::min(planes.size(), kPairs); ++i) {
        const Eigen::Vector3d& n = planes[i].normal;
        for (const Eigen::Vector3d& axis : image) add(axis - n.dot(axis) * n);
        for (std::size_t j = 0; j < i; ++j) add(n.cross(planes[j].normal));
    }
    for (const Eigen::Vector3d& axis : image) add(axis);
    return found;
}

double sin2_tolerance(const GravityRules& rules) {
    return std::pow(std::sin(radians(rules.tolerance_deg)), 2);
}

struct Judged {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    double odds = 0;  ///< logarithm
};

/// The answers, the best first. Those that have no chance any more are left out.
std::vector<Judged> judged(const RoomView& room, const Handling& handling, const GravityRules& rules) {
    const double tolerance = sin2_tolerance(rules);
    std::vector<Judged> found;
    for (const Eigen::Vector3d& u : answers(room, handling))
        found.push_back(
            {u, handling.log_turned(u) + handling.log_moved(u) + kPlanesOdds * room.square(u, tolerance)});
    const auto by_odds = [](const Judged& a, const Judged& b) { return a.odds > b.odds; };
    std::stable_sort(found.begin(), found.end(), by_odds);
    double best = -std::numeric_limits<double>::infinity();
    std::size_t count = 0;
    for (; count < found.size(); ++count) {
        Judged& judged = found[count];
        if (judged.odds + Handling::kMostHeld + kFacingOdds + kLowOdds < best - rules.margin) break;
        const RoomView::Reading reading = room.read(judged.up, tolerance);
        judged.odds += handling.log_held(judged.up) + kFacingOdds * reading.facing_up +
                       kLowOdds * reading.low - kHangingOdds * reading.hanging;
        best = std::max(best, judged.odds);
    }
    found.resize(count);
    std::stable_sort(found.begin(), found.end(), by_odds);
    return found;
}

/// The direction made exact by the planes that are level or upright about it.
Eigen::Vector3d refined(const Eigen::Vector3d& start, const RoomView& room, const GravityRules& rules) {
    const double tolerance = sin2_tolerance(rules);
    Eigen::Vector3d up = start;
    for (int i = 0; i < kRefinements; ++i) {
        // Up is where the sum of w (n . u)^2 over upright planes less that over level ones is smallest.
        Eigen::Matrix3d sum = -kToldWeight * start * start.transpose();
        for (const RoomView::Seen& plane : room.planes()) {
            const double fit = squareness(plane.normal, up, tolerance);
            if (fit != 0) sum -= plane.weight * fit * plane.normal * plane.normal.transpose();
        }
        const Eigen::Vector3d next =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(0);
        up = next.dot(up) < 0 ? (-next).eval() : next;
    }
    return up;
}

std::string number(double value) {
    return std::to_string(static_cast<int>(std::lround(value)));
}

}  // namespace

Up up_as_told(std::span<const Eigen::Vector3d> up_world, std::span<const MapPlane> planes,
              const std::string& by, const GravityRules& rules) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const Eigen::Vector3d& u : up_world) {
        if (!u.allFinite() || std::abs(u.norm() - 1) > 1e-3) continue;
        sum += u;
        count += 1;
    }
    if (count == 0) return {std::nullopt, by + " said nothing yet"};
    const double scatter_deg = degrees(std::acos(std::clamp(sum.norm() / count, -1.0, 1.0)));
    if (scatter_deg > rules.scatter_deg)
        return {std::nullopt, by + " says another direction each time (they scatter by " +
                                  number(scatter_deg) + " deg in the world)"};
    return {refined(sum.normalized(), RoomView(planes), rules), "by " + by};
}

Up find_up(std::span<const MapPlane> planes, std::span<const Pose> world_from_camera,
           const GravityRules& rules) {
    const RoomView room(planes);
    const std::optional<Handling> handling = Handling::of(world_from_camera);
    if (room.planes().empty()) return {std::nullopt, "there are no planes"};
    if (!handling) return {std::nullopt, "no keyframe has a pose"};

    const std::vector<Judged> found = judged(room, *handling, rules);
    const Judged& best = found.front();
    for (const Judged& other : found) {
        const double apart_deg = degrees(angle_between(other.up, best.up));
        if (apart_deg > rules.rival_deg && other.odds > best.odds - rules.margin)
            return {std::nullopt, "planes and motion leave two directions " + number(apart_deg) +
                                      " deg apart about as likely (1 to " +
                                      number(std::exp(best.odds - other.odds)) + ")"};
    }
    return {refined(best.up, room, rules), "by planes and motion"};
}

}  // namespace planemap::map
