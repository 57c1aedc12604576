// SPDX-License-Identifier: BSD-3-Clause
#include "messages/camera_flag.hpp"
#include "octomap/octomap_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("octomap",
                                        "The same depth and poses into an OctoMap, for comparison.");
    planemap::octomap::OctomapOptions options;
    planemap::messages::CameraFlag camera;
    camera.add_to(process.flags(), planemap::messages::kCameraOffTheBus);
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        return std::make_unique<planemap::octomap::OctomapShell>(
            bus, std::make_shared<planemap::messages::FrameDecoder>(bus, camera.read()), options,
            planemap::octomap::Building::kInBackground);
    });
}
