// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "core/camera_file.hpp"
#include "fuzz/fuzz.hpp"
#include "messages/convert.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    std::optional<CameraInfo> camera;
    try {
        std::vector<std::string> notes;
        camera = read_camera_file(file.path(), &notes);
    } catch (const std::runtime_error&) {
    } catch (const std::invalid_argument&) {
    }
    // Whatever the file may say, a receiver takes it.
    if (camera) messages::from_message(messages::to_message(*camera, 0, 0));
}

std::vector<std::string> seeds() {
    return {};
}

}  // namespace planemap::fuzz
