// SPDX-License-Identifier: BSD-3-Clause
#include "map/relation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/plane_intersection.hpp"
#include "map/opposite.hpp"

namespace planemap::map {

namespace {

constexpr double kDirectionIsKnown = 0.1;  // sine of an angle between normals from which its plane is known

/// How far along `along` from p a plane lies.
double distance_along(const Plane& plane, const Eigen::Vector3d& p, const Eigen::Vector3d& along) {
    return -plane.signed_distance(p) / plane.normal.dot(along);
}

bool is_finite(const MapPlane& plane) {
    return plane.normal.allFinite() && plane.center.allFinite() && std::isfinite(plane.angle);
}

Sides sides_of(const Plane& plane_a, const Plane& plane_b, const PlaneRelation& relation) {
    if (plane_a.normal.dot(plane_b.normal) > 0) return Sides::kSameWay;
    return plane_a.normal.dot(relation.on_b - relation.on_a) > 0 ? Sides::kFacing : Sides::kBackToBack;
}

std::optional<double> angle_sigma_of(const MapPlane& a, const MapPlane& b) {
    const auto certain_a = certainty_of(a), certain_b = certainty_of(b);
    if (!certain_a || !certain_b) return std::nullopt;
    const Eigen::Vector3d normal_a = a.plane().normal, normal_b = b.plane().normal;
    const double cosine = normal_a.dot(normal_b);
    Eigen::Vector3d towards_b = normal_b - cosine * normal_a, towards_a = normal_a - cosine * normal_b;
    if (towards_b.norm() < kDirectionIsKnown) towards_b.setZero(), towards_a.setZero();
    return std::hypot(certain_a->tilt_towards(a, towards_b), certain_b->tilt_towards(b, towards_a));
}

/// Fills in what is of parallel planes. `along` is their mean normal.
void add_distance(const MapPlane& a, const MapPlane& b, const Eigen::Vector3d& along,
                  PlaneRelation& relation) {
    const Plane plane_a = a.plane(), plane_b = b.plane();
    const auto between = [&](const Eigen::Vector3d& p) {
        return distance_along(plane_b, p, along) - distance_along(plane_a, p, along);
    };
    const Opposite opposite = opposite_of(a, b, along);
    const Eigen::Vector3d middle = opposite.cells.empty()
                                       ? Eigen::Vector3d(0.5 * (a.center + b.center).cast<double>())
                                       : opposite.middle();
    relation.distance = relation.least = relation.most = std::abs(between(middle));
    relation.on_a = middle + distance_along(plane_a, middle, along) * along;
    relation.on_b = middle + distance_along(plane_b, middle, along) * along;
    relation.opposite = opposite.area();
    for (const Eigen::Vector2d& cell : opposite.cells) {
        const double here = std::abs(between(opposite.in_world(cell)));
        relation.least = std::min(relation.least, here);
        relation.most = std::max(relation.most, here);
    }
    relation.sides = sides_of(plane_a, plane_b, relation);
    const auto certain_a = certainty_of(a), certain_b = certainty_of(b);
    if (!certain_a || !certain_b) return;
    relation.distance_sigma =
        std::hypot(certain_a->offset_at(a, relation.on_a), certain_b->offset_at(b, relation.on_b));
}

}  // namespace

double PlaneCertainty::offset_at(const MapPlane& plane, const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d p = plane.world_from_plane().inverse(Eigen::Isometry) * p_world;
    return std::hypot(offset, slopes.x() * p.x(), slopes.y() * p.y());
}

double PlaneCertainty::tilt_towards(const MapPlane& plane, const Eigen::Vector3d& direction) const {
    const Eigen::Matrix3d axes = plane.world_from_plane().linear();
    const Eigen::Vector2d in_plane = (axes.transpose() * direction).head<2>();
    if (!(in_plane.norm() > 0)) return slopes.maxCoeff();
    return slopes.cwiseProduct(in_plane.normalized()).norm();
}

std::optional<PlaneCertainty> certainty_of(const MapPlane& plane) {
    const double rms = plane.rms;
    if (!(rms > 0) || !std::isfinite(rms) || plane.keyframes < 1) return std::nullopt;
    if (!(plane.half_extents.minCoeff() > 0) || !plane.half_extents.allFinite()) return std::nullopt;
    PlaneCertainty certainty;
    certainty.offset = rms / std::sqrt(static_cast<double>(plane.keyframes));
    // Of readings all over the box: their spread is its half extents over the root of 3.
    certainty.slopes =
        std::numbers::sqrt3 * certainty.offset * plane.half_extents.cast<double>().cwiseInverse();
    return certainty;
}

PlaneRelation relation(const MapPlane& a, const MapPlane& b) {
    if (b.id < a.id) {
        PlaneRelation turned = relation(b, a);
        std::swap(turned.on_a, turned.on_b);
        return turned;
    }
    const Plane plane_a = a.plane(), plane_b = b.plane();
    PlaneRelation relation;
    relation.angle = angle_between(plane_a.normal, plane_b.normal);
    if (!is_finite(a) || !is_finite(b)) {
        relation.angle = std::numeric_limits<double>::quiet_NaN();
        return relation;
    }
    relation.angle_sigma = angle_sigma_of(a, b);
    if (std::min(relation.angle, std::numbers::pi - relation.angle) > kParallel_rad) return relation;
    const double side = plane_a.normal.dot(plane_b.normal) > 0 ? 1 : -1;
    add_distance(a, b, (plane_a.normal + side * plane_b.normal).normalized(), relation);
    return relation;
}

}  // namespace planemap::map
