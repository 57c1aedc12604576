// SPDX-License-Identifier: BSD-3-Clause
// What a depth sensor does not see as it is: a mirror, glass, and black.
#include "simulator/looks.hpp"
#include "simulator/office.hpp"

namespace planemap::simulator {

World make_glass(std::uint64_t seed, double texel_scale) {
    WorldBuilder office("glass", seed, texel_scale);
    add_office(office, true);
    office.use(Material::kMirror);
    office.add_panel("room mirror", {2.72, 4.98, 2.0}, kEast, kDown, 0.8, 1.6, kGrey);
    office.add_panel("corridor mirror", {3.9, -1.70, 2.1}, kWest, kDown, 1.2, 1.9, kGrey);
    office.use(Material::kGlass);
    office.add_panel("pane", {4.55, 2.7, 2.0}, kSouth, kDown, 1.3, 2.0, kGrey);
    office.use(Material::kBlack);
    office.add_box("black cupboard", {{2.75, 0.35, 0}, kWest}, {0.5, 0.35, 1.0}, kPlastic, kPlastic,
                   {.back = true, .bottom = true});
    World& world = office.world();
    world.tour = office_tour();
    return std::move(world);
}

}  // namespace planemap::simulator
