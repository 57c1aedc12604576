// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation_shell.hpp"

int main(int argc, char** argv) {
    planemap::Process process("segmentation", "Depth images to planar regions.");
    planemap::segmentation::SegmentationOptions options;
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::Bus& bus) {
        return std::make_unique<planemap::segmentation::SegmentationShell>(
            bus, std::make_shared<planemap::FrameDecoder>(bus), options);
    });
}
