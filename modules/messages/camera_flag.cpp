// SPDX-License-Identifier: BSD-3-Clause
#include "messages/camera_flag.hpp"

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "core/camera_file.hpp"

namespace planemap::messages {

void CameraFlag::add_to(Flags& flags, const char* what_for) {
    flags.add("camera", file_, what_for);
}

std::optional<CameraInfo> CameraFlag::read() const {
    if (file_.empty()) return std::nullopt;
    std::vector<std::string> notes;
    CameraInfo camera = read_camera_file(file_, &notes);
    for (const std::string& note : notes) spdlog::warn("{}", note);
    return camera;
}

}  // namespace planemap::messages
