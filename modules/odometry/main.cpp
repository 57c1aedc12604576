// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

int main(int argc, char** argv) {
    planemap::Process process("odometry", "Frames and planar regions to the camera's motion, and keyframes.");
    planemap::OdometryOptions options;
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::Bus& bus) {
        return std::make_unique<planemap::OdometryShell>(bus, std::make_shared<planemap::FrameDecoder>(bus),
                                                         options);
    });
}
