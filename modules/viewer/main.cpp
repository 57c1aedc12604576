// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("viewer",
                                        "What is on the bus as small pictures for lcm-spy and as collections "
                                        "for Director and libbot's viewers.");
    planemap::viewer::ViewerOptions options;
    bool no_previews = false, no_collections = false;
    process.flags().add(options_of(options));
    process.flags().add("no-previews", no_previews, "No PLANEMAP_PREVIEW_COLOR, _DEPTH and _REGIONS");
    process.flags().add("no-collections", no_collections, "No OBJECT_COLLECTION and POINTS_COLLECTION");
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        options.previews = !no_previews;
        options.collections = !no_collections;
        return std::make_unique<planemap::viewer::ViewerShell>(
            bus, std::make_shared<planemap::messages::FrameDecoder>(bus), options);
    });
}
