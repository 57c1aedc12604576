// SPDX-License-Identifier: BSD-3-Clause
#include "messages/camera_flag.hpp"
#include "odometry/odometry_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("odometry",
                                        "Frames and planar regions to the camera's motion, and keyframes.");
    planemap::odometry::OdometryOptions options;
    planemap::messages::CameraFlag camera;
    camera.add_to(process.flags(), planemap::messages::kCameraOffTheBus);
    process.flags().add(options_of(options));
    process.flags().add(options_of(options.motion));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        return std::make_unique<planemap::odometry::OdometryShell>(
            bus, std::make_shared<planemap::messages::FrameDecoder>(bus, camera.read()), options,
            process.journal());
    });
}
