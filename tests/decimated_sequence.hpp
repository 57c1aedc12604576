// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/camera_file.hpp"
#include "core/files.hpp"
#include "sensor/dataset.hpp"
#include "sensor/png.hpp"

namespace planemap::test {

/// The depth image with every factor-th reading of each row and column, each the one nearest to the new
/// pixel's centre.
inline DepthImage decimated(const DepthImage& depth, double factor) {
    DepthImage out(static_cast<int>(depth.width / factor), static_cast<int>(depth.height / factor));
    const auto from = [&](int i, int size) {
        return std::clamp(static_cast<int>(std::lround((i + 0.5) * factor - 0.5)), 0, size - 1);
    };
    for (int v = 0; v < out.height; ++v) {
        for (int u = 0; u < out.width; ++u) out(u, v) = depth(from(u, depth.width), from(v, depth.height));
    }
    return out;
}

/// Writes a recording of the TUM layout whose depth camera has 1 / factor of the resolution; colour stays as
/// it was. With `registered` false the two cameras are said to be two, in one place.
inline void write_decimated(const std::filesystem::path& from, const std::filesystem::path& to, double factor,
                            bool registered) {
    using Json = nlohmann::json;
    const auto json = [](const PinholeCamera& camera) {
        return Json{{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
                    {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
    };
    const CameraInfo camera = camera_of_folder(from);
    PinholeCamera coarse = camera.depth;
    coarse.width = static_cast<int>(coarse.width / factor);
    coarse.height = static_cast<int>(coarse.height / factor);
    coarse.fx /= factor;
    coarse.fy /= factor;
    coarse.cx = (coarse.cx + 0.5) / factor - 0.5;
    coarse.cy = (coarse.cy + 0.5) / factor - 0.5;
    Json file = {{"depth_camera", json(coarse)},
                 {"color_camera", json(camera.color)},
                 {"depth_units_per_metre", camera.depth_units_per_metre},
                 {"registered", registered}};
    if (!registered)
        file["color_from_depth"] = {{"rotation_vector_rad", {0, 0, 0}}, {"translation_m", {0, 0, 0}}};
    std::filesystem::create_directories(to / "depth");
    write_file(to / "camera.json", file.dump());
    for (const char* name : {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt"}) {
        if (std::filesystem::exists(from / name)) std::filesystem::copy_file(from / name, to / name);
    }
    std::filesystem::create_directory_symlink(std::filesystem::absolute(from / "rgb"), to / "rgb");
    const sensor::Dataset dataset(from);
    for (const sensor::ListedFrame& frame : dataset.frames()) {
        const DepthImage depth = sensor::decode_depth_png(read_file(from / frame.depth.file),
                                                          camera.depth.width, camera.depth.height);
        sensor::write_depth_png(to / frame.depth.file, decimated(depth, factor));
    }
}

}  // namespace planemap::test
