// SPDX-License-Identifier: BSD-3-Clause
// A papered room: whether its pattern comes again decides whether a view says where it is.
#include <algorithm>

#include "simulator/looks.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr double kX = 5, kY = 4, kZ = 2.6;
constexpr double kStrip = 2;  // metres after which a pattern comes again

/// Puts up strips of kStrip side by side, each `height` high, from `corner` for `width`; the last one is cut.
class Paperhanger {
  public:
    Paperhanger(WorldBuilder& room, bool repeats) : room_(room), repeats_(repeats) {}

    /// A wall from its upper left corner, or a row of a floor or ceiling.
    void hang(const std::string& surface, const Vector3d& corner, const Vector3d& right, const Vector3d& down,
              double width, double height, const Look& look, bool with_pictures) {
        const std::size_t first = count();
        draw(surface, corner, right, down, height, look, with_pictures);
        const std::size_t end = count();
        for (double left = kStrip; left < width; left += kStrip) {
            if (repeats_)
                copy(first, end, left * right);
            else
                draw(surface, corner + left * right, right, down, height, look, with_pictures);
        }
        cut(first, corner, right, width);
    }

    /// Two rows of kStrip each, as hang() puts one up.
    void lay(const std::string& surface, const Vector3d& corner, const Vector3d& right, const Vector3d& down,
             const Look& look) {
        const std::size_t first = count();
        hang(surface, corner, right, down, kX, kStrip, look, false);
        if (repeats_)
            copy(first, count(), kStrip * down);
        else
            hang(surface, corner + kStrip * down, right, down, kX, kStrip, look, false);
    }

  private:
    std::size_t count() { return room_.world().rectangles.size(); }

    void copy(std::size_t from, std::size_t to, const Vector3d& by) {
        std::vector<Rectangle>& all = room_.world().rectangles;
        for (std::size_t i = from; i < to; ++i) {
            all.push_back(Rectangle(all[i]));
            all.back().centre += by;
        }
    }

    void draw(const std::string& surface, const Vector3d& corner, const Vector3d& right, const Vector3d& down,
              double height, const Look& look, bool with_pictures) {
        room_.add_panel(surface, corner, right, down, kStrip, height, look);
        if (!with_pictures) return;
        room_.add_picture(0.10, 0.55, 0.5, 0.7, kPoster);
        room_.add_picture(0.75, 0.80, 0.4, 0.5, kPoster);
        room_.add_picture(1.35, 0.50, 0.5, 0.6, kPoster);
        room_.add_picture(0.35, 1.55, 0.6, 0.4, kPoster);
        room_.add_picture(1.25, 1.40, 0.4, 0.6, kPoster);
    }

    /// Nothing goes beyond `width` from the corner.
    void cut(std::size_t first, const Vector3d& corner, const Vector3d& right, double width) {
        std::vector<Rectangle>& all = room_.world().rectangles;
        for (std::size_t i = first; i < all.size(); ++i) {
            Rectangle& piece = all[i];
            const double half = piece.half_u.norm();
            const double from = (piece.centre - corner).dot(right) - half;
            const double keep = std::min(2 * half, width - from);
            if (keep >= 2 * half) continue;
            piece.texture_to.x() *= keep / (2 * half);
            piece.half_u = keep / 2 * right;
            piece.centre += (keep / 2 - half) * right;
        }
        const auto gone =
            std::remove_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                           [&](const Rectangle& piece) { return piece.half_u.dot(right) < 1e-9; });
        all.erase(gone, all.end());
    }

    WorldBuilder& room_;
    bool repeats_;
};

/// Along each wall, looking at it alone, and a turn in each corner.
std::vector<Waypoint> room_tour() {
    return {{{1.4, 1.9, 1.4}, {1.3, 4.0, 1.3}}, {{1.9, 1.9, 1.4}, {1.9, 4.0, 1.3}},
            {{2.4, 1.9, 1.4}, {2.4, 4.0, 1.3}}, {{2.9, 1.9, 1.4}, {2.9, 4.0, 1.3}},
            {{3.4, 1.9, 1.4}, {3.5, 4.0, 1.3}}, {{3.5, 1.9, 1.4}, {4.7, 3.7, 1.3}},
            {{3.3, 2.1, 1.4}, {5.0, 2.9, 1.3}}, {{3.1, 2.2, 1.4}, {5.0, 2.3, 1.3}},
            {{3.1, 1.8, 1.4}, {5.0, 1.7, 1.3}}, {{3.3, 1.8, 1.4}, {5.0, 1.0, 1.3}},
            {{3.5, 2.0, 1.4}, {4.7, 0.3, 1.3}}, {{3.6, 2.1, 1.4}, {3.7, 0.0, 1.3}},
            {{3.1, 2.1, 1.4}, {3.1, 0.0, 1.3}}, {{2.6, 2.1, 1.4}, {2.6, 0.0, 1.3}},
            {{2.1, 2.1, 1.4}, {2.1, 0.0, 1.3}}, {{1.6, 2.1, 1.4}, {1.5, 0.0, 1.3}},
            {{1.5, 2.1, 1.4}, {0.3, 0.3, 1.3}}, {{1.7, 1.9, 1.4}, {0.0, 1.1, 1.3}},
            {{1.9, 1.8, 1.4}, {0.0, 1.7, 1.3}}, {{1.9, 2.2, 1.4}, {0.0, 2.3, 1.3}},
            {{1.7, 2.2, 1.4}, {0.0, 3.0, 1.3}}, {{1.5, 2.0, 1.4}, {0.3, 3.7, 1.3}}};
}

World make_papered(const std::string& name, bool repeats, std::uint64_t seed, double texel_scale) {
    WorldBuilder room(name, seed, texel_scale);
    Paperhanger hanger(room, repeats);
    hanger.hang("north wall", {0, kY, kZ}, kEast, kDown, kX, kZ, kWhite, true);
    hanger.hang("east wall", {kX, kY, kZ}, kSouth, kDown, kY, kZ, kYellow, true);
    hanger.hang("south wall", {kX, 0, kZ}, kWest, kDown, kX, kZ, kBlue, true);
    hanger.hang("west wall", {0, 0, kZ}, kNorth, kDown, kY, kZ, kWhite, true);
    hanger.lay("ceiling", {0, 0, kZ}, kEast, kNorth, kCeilingBoards);
    hanger.lay("floor", {0, kY, 0}, kEast, kSouth, kFloorTiles);
    World& world = room.world();
    world.tour = room_tour();
    world.places = {world.tour[2], world.tour[8], world.tour[13], world.tour[19]};
    world.free_from = {0.8, 0.8, 0.4};
    world.free_to = {4.2, 3.2, 2.2};
    return std::move(world);
}

}  // namespace

World make_wallpaper(std::uint64_t seed, double texel_scale) {
    return make_papered("wallpaper", true, seed, texel_scale);
}

World make_mural(std::uint64_t seed, double texel_scale) {
    return make_papered("mural", false, seed, texel_scale);
}

}  // namespace planemap::simulator
