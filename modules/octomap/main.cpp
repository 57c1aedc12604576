// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>

#include "messages/camera_flag.hpp"
#include "octomap/octomap_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("octomap",
                                        "The same depth and poses into an OctoMap, for comparison.");
    planemap::octomap::OctomapOptions options;
    planemap::messages::CameraFlag camera;
    camera.add_to(process.flags(), planemap::messages::kCameraOffTheBus);
    planemap::octomap::OctomapFiles files;
    process.flags().add("o,output", files.output,
                        "Folder for octomap.bt at the end; without it nothing is written");
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        // It is there for comparison: who needs the time goes before it.
        constexpr int kNiceness = 10;
        if (::nice(kNiceness) == -1 && errno != 0) spdlog::warn("octomap: cannot make itself nice");
        files.journal = process.journal();
        return std::make_unique<planemap::octomap::OctomapShell>(
            bus, std::make_shared<planemap::messages::FrameDecoder>(bus, camera.read()), options,
            planemap::octomap::Building::kInBackground, files);
    });
}
