// SPDX-License-Identifier: BSD-3-Clause
// write_fakenect INPUT FOLDER FRAMES: a recording for libfreenect's fakenect library.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "camera/fakenect.hpp"
#include "messages/image_codec.hpp"
#include "sensor/source.hpp"

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    try {
        const auto source = planemap::sensor::open_source(argv[1]);
        planemap::camera::write_fakenect(
            *source, argv[2], static_cast<std::size_t>(std::atoi(argv[3])),
            [](const planemap::SensorFrame& frame, const planemap::PinholeCamera& camera) {
                return frame.color_jpeg.empty() ? frame.color
                                                : planemap::messages::decode_jpeg_colors(
                                                      frame.color_jpeg, camera.width, camera.height);
            });
    } catch (const std::exception& error) {
        std::fprintf(stderr, "write_fakenect: %s\n", error.what());
        return 1;
    }
    return 0;
}
