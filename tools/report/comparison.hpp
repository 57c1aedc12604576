// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/subject.hpp"

namespace planemap {

/// What differs between two maps: "a", "b" (paths), "figures" (name, pointer, a, b; those that differ),
/// "figures_alike" (how many do not), "options" (flag, a, b), "world_frames" (are_one, why), and, where these
/// are one, "planes": in_place, moved, appeared, gone; else null. Throws std::runtime_error naming the file
/// if a map cannot be read.
nlohmann::ordered_json compare(const Subject& a, const Subject& b);

/// The same for people.
std::string comparison_markdown(const nlohmann::ordered_json& comparison);

}  // namespace planemap
