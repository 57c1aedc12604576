// SPDX-License-Identifier: BSD-3-Clause
// A world of textured rectangles. World frame: x and y level, z up, metres.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/plane.hpp"
#include "simulator/body.hpp"
#include "simulator/texture.hpp"

namespace planemap::simulator {

/// One plane of the world: what a map should hold. Its rectangles all lie on it.
struct Surface {
    std::string name;
    Plane plane;  ///< world frame; the normal points to the side that can be seen
};

/// What light does at a surface, and so what a depth sensor reads there.
enum class Material {
    kMatt,    ///< scatters it: its own depth
    kBlack,   ///< swallows a sensor's light: no reading; an eye sees its texture
    kMirror,  ///< throws it back: the depth of what is mirrored, along the ray beyond the mirror
    kGlass,   ///< lets it through: the depth of what is behind, or nothing
};

/// A textured rectangle, seen from the side its surface's normal points to.
struct Rectangle {
    int surface = -1;        ///< index of its surface
    int texture = -1;        ///< index of its texture
    Eigen::Vector3d centre;  ///< world frame, metres
    Eigen::Vector3d half_u;  ///< from the centre to the middle of the right edge, as seen from the front
    Eigen::Vector3d half_v;  ///< from the centre to the middle of the lower edge; perpendicular to half_u
    bool picture = false;    ///< covers another rectangle of its surface
    Material material = Material::kMatt;
    int body = -1;        ///< index of the body that it is part of; -1: of none, it is always there
    bool absent = false;  ///< not there at this time, see World::at()
    /// Texture coordinates of the upper left and the lower right corner; (0, 0) and (1, 1) show the whole.
    Eigen::Vector2d texture_from{0, 0}, texture_to{1, 1};

    /// Upper left, lower left, lower right, upper right: counter-clockwise about the normal.
    std::array<Eigen::Vector3d, 4> corners() const {
        return {centre - half_u - half_v, centre - half_u + half_v, centre + half_u + half_v,
                centre + half_u - half_v};
    }
    /// The point of the rectangle that is nearest to p.
    Eigen::Vector3d nearest(const Eigen::Vector3d& p) const;
};

/// A lamp; it shines in all directions, and nothing casts a shadow.
struct Lamp {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world frame, metres
    double power = 1;  ///< light that arrives square on at one metre, as a share of the ambient light
};

/// A place to walk through: the camera goes near `position` and looks about to `target`. World frame, metres.
struct Waypoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), target = Eigen::Vector3d::UnitX();
};

struct World {
    std::string name;
    std::vector<Surface> surfaces;
    std::vector<Rectangle> rectangles;  ///< of one surface, a later one covers an earlier one
    std::vector<std::shared_ptr<const Texture>> textures;  ///< shared by the worlds of all times
    std::vector<Body> bodies;  ///< what moves, comes or goes; a surface is of one body or of none
    std::vector<Lamp> lamps;
    std::vector<Waypoint> tour;  ///< a closed walk; about a step apart
    double pace = 1;             ///< of the walk, as a share of the hand's speed and turning rate
    bool whole_tour = false;     ///< a walk without a given length goes once around
    /// Where a walk in random order stops, see wander(); the straight way between any two is free.
    std::vector<Waypoint> places;
    /// The free space that a hand-held trajectory from elsewhere is put into: a box, world frame, metres.
    Eigen::Vector3d free_from = Eigen::Vector3d::Zero(), free_to = Eigen::Vector3d::Zero();

    /// Distance from p to the nearest rectangle that is there, metres.
    double clearance(const Eigen::Vector3d& p) const;

    /// The world `seconds` after the change (before: negative): each body where it is then, the rectangles of
    /// those that are not there marked `absent`. Indices stay.
    World at(double seconds) const;
};

/// A hole in a panel, metres from its upper left corner.
struct Hole {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// Adds things to a world.
class WorldBuilder {
  public:
    WorldBuilder(std::string name, std::uint64_t seed, double texel_scale = 1)
        : seed_(seed), texel_scale_(texel_scale) {
        world_.name = std::move(name);
    }

    /// A flat panel, as a new surface or as another part of the surface of that name: `corner` is its upper
    /// left, `right` and `down` the directions of its edges as seen from the front (unit, perpendicular).
    /// Holes do not overlap.
    void add_panel(const std::string& name, const Eigen::Vector3d& corner, const Eigen::Vector3d& right,
                   const Eigen::Vector3d& down, double width, double height, const Look& look,
                   std::span<const Hole> holes = {});

    /// A picture stuck flat on the surface of the panel that was added last, `left` and `top` metres from its
    /// corner.
    void add_picture(double left, double top, double width, double height, const Look& look);

    /// Which faces of a box are left out because nothing ever sees them.
    struct Hidden {
        bool back = false, bottom = false, left = false, right = false, top = false;
    };
    /// Where a box stands: the lower left corner of its front face as seen from the front, and the directions
    /// of that face's edges (unit, perpendicular).
    struct Place {
        Eigen::Vector3d front_left = Eigen::Vector3d::Zero(), right = Eigen::Vector3d::UnitX(),
                        up = Eigen::Vector3d::UnitZ();
    };
    /// Size of a box: along the front face, away from the viewer, and up. Metres.
    struct Size {
        double width = 0, depth = 0, height = 0;
    };
    /// A box as up to six surfaces "NAME front", "NAME top" and so on. The front looks like `front`, all else
    /// like `look`.
    void add_box(const std::string& name, const Place& place, const Size& size, const Look& look,
                 const Look& front, const Hidden& hidden);

    /// What is added from here on is part of this body, in its place of rest (Pose::Identity()), until
    /// end_body().
    void begin_body(Body body);
    void end_body() { body_ = -1; }

    /// What is added from here on is made of this.
    void use(Material material) { material_ = material; }

    /// All that is in another world, moved by `offset`: its surfaces under their names with `prefix` before
    /// them, or as parts of a surface that is on the same plane; its textures as they are, its lamps.
    void add_world(const World& other, const Eigen::Vector3d& offset, const std::string& prefix);

    World& world() { return world_; }

  private:
    int surface_of(const std::string& name, const Plane& plane);
    int add_texture(const Look& look, double width, double height);

    World world_;
    std::uint64_t seed_;
    double texel_scale_;
    int body_ = -1;
    Material material_ = Material::kMatt;
    Eigen::Vector3d corner_ = Eigen::Vector3d::Zero(), right_ = Eigen::Vector3d::UnitX(),
                    down_ = Eigen::Vector3d::UnitY();  // of the last panel
};

/// An office of 6 x 5 x 2.7 m with tables, cupboards, a shelf, a window, one wall at 56 deg to another, and
/// an open door to a corridor.
/// The seed decides its textures, texel_scale how fine they are (see make_texture()).
World make_office(std::uint64_t seed, double texel_scale = 1);

/// A corridor of 2.4 m around a block: one round of its tour is 100 m.
World make_building(std::uint64_t seed, double texel_scale = 1);

/// Two of the office's room, alike to the last texel, 7 m apart; their doors lead to one corridor.
World make_twins(std::uint64_t seed, double texel_scale = 1);

/// A hall; its tour passes 1.3 m before a wall of which 6 m are bare paint, and nothing else is in view.
World make_wall(std::uint64_t seed, double texel_scale = 1);

/// The office with a mirror, a pane of glass and a black cupboard.
World make_glass(std::uint64_t seed, double texel_scale = 1);

/// The office, where a camera looks on while one thing changes: a box appears, vanishes, or moves by 35 cm;
/// the door, closed before, opens; a person walks in, stands and leaves.
World make_appearing(std::uint64_t seed, double texel_scale = 1);
World make_vanishing(std::uint64_t seed, double texel_scale = 1);
World make_moved(std::uint64_t seed, double texel_scale = 1);
World make_door(std::uint64_t seed, double texel_scale = 1);
World make_walker(std::uint64_t seed, double texel_scale = 1);

/// Twenty furnished rooms on both sides of a corridor of 46 m; the tour enters one after another.
World make_rooms(std::uint64_t seed, double texel_scale = 1);

/// An empty room of 5 x 4 m. Of the wallpaper, what stands on each wall comes again every 2 m, to the last
/// texel, so that a view of one wall alone fits two places and more; of the mural, in the same room, nothing
/// does.
World make_wallpaper(std::uint64_t seed, double texel_scale = 1);
World make_mural(std::uint64_t seed, double texel_scale = 1);

/// Thousands of small boxes any way up around the camera, 4 to 12 cm wide: texture, and no plane.
World make_clutter(std::uint64_t seed, double texel_scale = 1);

}  // namespace planemap::simulator
