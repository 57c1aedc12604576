// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("map",
                                        "Keyframes' planar regions and the trajectory to the plane map.");
    planemap::map::MapShellOptions options;
    process.flags().add("o,output", options.output,
                        "Folder for plane_map.lcmlog; without it nothing is written");
    process.flags().add("needs-planes", options.needs_planes,
                        "End with code 1 if there is no plane in the map at the end");
    process.flags().add(
        "map", options.start,
        "plane_map.lcmlog to start from, in the world frame of this run: its planes keep their ids "
        "and grow on");
    process.flags().add(options_of(options.map));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        options.journal = process.journal();
        return std::make_unique<planemap::map::MapShell>(bus, options);
    });
}
