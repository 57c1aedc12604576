// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/world.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "simulator/random.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

Vector3d Rectangle::nearest(const Vector3d& p) const {
    const Vector3d offset = p - centre;
    const double u = std::clamp(offset.dot(half_u) / half_u.squaredNorm(), -1.0, 1.0);
    const double v = std::clamp(offset.dot(half_v) / half_v.squaredNorm(), -1.0, 1.0);
    return centre + u * half_u + v * half_v;
}

double World::clearance(const Vector3d& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Rectangle& rectangle : rectangles) {
        if (rectangle.absent) continue;
        least = std::min(least, (rectangle.nearest(p) - p).norm());
    }
    return least;
}

World World::at(double seconds) const {
    World then = *this;
    if (bodies.empty()) return then;
    std::vector<Pose> world_from_rest;
    for (const Body& body : bodies) world_from_rest.push_back(body.pose_at(seconds));
    std::vector<int> body_of(surfaces.size(), -1);
    for (Rectangle& rectangle : then.rectangles) {
        if (rectangle.body < 0) continue;
        const auto body = static_cast<std::size_t>(rectangle.body);
        body_of[static_cast<std::size_t>(rectangle.surface)] = rectangle.body;
        const Pose& moved = world_from_rest[body];
        rectangle.absent = !bodies[body].is_there(seconds);
        rectangle.centre = moved * rectangle.centre;
        rectangle.half_u = moved.linear() * rectangle.half_u;
        rectangle.half_v = moved.linear() * rectangle.half_v;
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (body_of[i] < 0) continue;
        then.surfaces[i].plane = world_from_rest[static_cast<std::size_t>(body_of[i])] * surfaces[i].plane;
    }
    return then;
}

void WorldBuilder::begin_body(Body body) {
    body_ = static_cast<int>(world_.bodies.size());
    world_.bodies.push_back(std::move(body));
}

int WorldBuilder::surface_of(const std::string& name, const Plane& plane) {
    auto& surfaces = world_.surfaces;
    const auto known =
        std::find_if(surfaces.begin(), surfaces.end(), [&](const Surface& s) { return s.name == name; });
    if (known == surfaces.end()) {
        surfaces.push_back({name, plane});
        return static_cast<int>(surfaces.size()) - 1;
    }
    if ((known->plane.normal - plane.normal).norm() > 1e-9 || std::abs(known->plane.d - plane.d) > 1e-9) {
        throw std::logic_error("surface " + name + " has two planes");
    }
    return static_cast<int>(known - surfaces.begin());
}

int WorldBuilder::add_texture(const Look& look, double width, double height) {
    const auto index = world_.textures.size();
    world_.textures.push_back(
        std::make_shared<const Texture>(make_texture(look, width, height, mix(seed_, index), texel_scale_)));
    return static_cast<int>(index);
}

void WorldBuilder::add_panel(const std::string& name, const Vector3d& corner, const Vector3d& right,
                             const Vector3d& down, double width, double height, const Look& look,
                             std::span<const Hole> holes) {
    corner_ = corner;
    right_ = right;
    down_ = down;
    const Vector3d normal = down.cross(right);
    const int surface = surface_of(name, {normal, -normal.dot(corner)});
    const int texture = add_texture(look, width, height);
    // A grid through all edges of holes; its cells are merged to columns that hold no hole.
    std::set<double> columns{0.0, width};
    for (const Hole& hole : holes) columns.insert({hole.left, hole.right});
    for (auto left = columns.begin(), next = std::next(left); next != columns.end(); ++left, ++next) {
        const double middle = 0.5 * (*left + *next);
        std::set<std::pair<double, double>> gaps;
        for (const Hole& hole : holes) {
            if (hole.left < middle && middle < hole.right) gaps.insert({hole.top, hole.bottom});
        }
        gaps.insert({height, height});
        double top = 0;
        for (const auto& [gap_top, gap_bottom] : gaps) {
            if (gap_top > top) {
                Rectangle part;
                part.surface = surface;
                part.texture = texture;
                part.material = material_;
                part.body = body_;
                part.half_u = 0.5 * (*next - *left) * right;
                part.half_v = 0.5 * (gap_top - top) * down;
                part.centre = corner + middle * right + 0.5 * (top + gap_top) * down;
                part.texture_from = {*left / width, top / height};
                part.texture_to = {*next / width, gap_top / height};
                world_.rectangles.push_back(part);
            }
            top = gap_bottom;
        }
    }
}

void WorldBuilder::add_picture(double left, double top, double width, double height, const Look& look) {
    Rectangle picture;
    picture.surface = world_.rectangles.back().surface;
    picture.picture = true;
    picture.material = world_.rectangles.back().material;
    picture.body = world_.rectangles.back().body;
    picture.texture = add_texture(look, width, height);
    picture.half_u = 0.5 * width * right_;
    picture.half_v = 0.5 * height * down_;
    picture.centre = corner_ + (left + 0.5 * width) * right_ + (top + 0.5 * height) * down_;
    world_.rectangles.push_back(picture);
}

void WorldBuilder::add_world(const World& other, const Vector3d& offset, const std::string& prefix) {
    const int first_texture = static_cast<int>(world_.textures.size());
    const int first_body = static_cast<int>(world_.bodies.size());
    world_.bodies.insert(world_.bodies.end(), other.bodies.begin(), other.bodies.end());
    const auto before = static_cast<std::ptrdiff_t>(world_.surfaces.size());
    world_.textures.insert(world_.textures.end(), other.textures.begin(), other.textures.end());
    std::vector<int> surface_here;
    for (const Surface& surface : other.surfaces) {
        const Plane plane{surface.plane.normal, surface.plane.d - surface.plane.normal.dot(offset)};
        const auto end = world_.surfaces.begin() + before;
        const auto same = std::find_if(world_.surfaces.begin(), end, [&](const Surface& known) {
            return (known.plane.normal - plane.normal).norm() < 1e-9 &&
                   std::abs(known.plane.d - plane.d) < 1e-9;
        });
        surface_here.push_back(same != end ? static_cast<int>(same - world_.surfaces.begin())
                                           : surface_of(prefix + surface.name, plane));
    }
    for (Rectangle rectangle : other.rectangles) {
        rectangle.surface = surface_here[static_cast<std::size_t>(rectangle.surface)];
        rectangle.texture += first_texture;
        if (rectangle.body >= 0) rectangle.body += first_body;
        rectangle.centre += offset;
        world_.rectangles.push_back(rectangle);
    }
    for (Lamp lamp : other.lamps) {
        lamp.position += offset;
        world_.lamps.push_back(lamp);
    }
}

void WorldBuilder::add_box(const std::string& name, const Place& place, const Size& size, const Look& look,
                           const Look& front, const Hidden& hidden) {
    const Vector3d &r = place.right, &up = place.up, f = up.cross(r);
    const auto [w, d, h] = size;
    const Vector3d low = place.front_left, high = low + h * up;
    if (!hidden.back) add_panel(name + " back", high + d * f + w * r, -r, -up, w, h, look);
    if (!hidden.left) add_panel(name + " left", high + d * f, -f, -up, d, h, look);
    if (!hidden.right) add_panel(name + " right", high + w * r, f, -up, d, h, look);
    if (!hidden.top) add_panel(name + " top", high + d * f, r, -f, w, d, look);
    if (!hidden.bottom) add_panel(name + " bottom", low, r, f, w, d, look);
    add_panel(name + " front", high, r, -up, w, h, front);
}

}  // namespace planemap::simulator
