// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "simulator/simulated_source.hpp"

namespace planemap::simulator {

/// A plane of a world with the time in which it is at that place.
struct TimedSurface {
    int surface = -1;  ///< index into World::surfaces
    int body = -1;     ///< index into World::bodies; -1: it is always there
    Body::Stay stay;   ///< seconds after the world's change
};

/// All planes that stand still for a second or longer, by surface and then by time.
std::vector<TimedSurface> timed_surfaces(const World& world);

/// Writes what is true of a source as JSON: {"world": name, "planes": [{"id", "name", "normal": [x, y, z],
/// "d", "area", "rectangles": [[4 corners]...]}]}; world frame (z up), metres, n.p + d = 0, normals towards
/// the visible side, corners counter-clockwise about the normal. Pictures are left out: they cover other
/// rectangles of their plane. Planes that are not always there have "from" or "until" or both, seconds as
/// in groundtruth.txt, and "body"; what moves is a plane of its own at each place where it stands for a
/// second, and "bodies" says when each is there at all. Planes that are not matt have "material". A sensor
/// with errors that stay is described as "sensor". `log` is the name of the log beside the file that it tells
/// the truth of, and is added as "log"; empty: none. Throws std::runtime_error naming the file.
void write_planes_truth(const std::filesystem::path& file, const SimulatedSource& source,
                        const std::string& log = {});

}  // namespace planemap::simulator
