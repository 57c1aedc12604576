// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

int main(int argc, char** argv) {
    planemap::Process process("octomap", "The same depth and poses into an OctoMap, for comparison.");
    planemap::OctomapOptions options;
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::Bus& bus) {
        return std::make_unique<planemap::OctomapShell>(bus, std::make_shared<planemap::FrameDecoder>(bus),
                                                        options, planemap::Building::kInBackground);
    });
}
