// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap {

/// What the user should know about the input or the result, a line each: most frames lost, frames further
/// apart in time than tracking is made for (unless poses were given), and a trajectory whose scale is off the
/// truth's. `reason_lost` is Pipeline::reason_lost(). Reads the report's "frames", "tracked" and "accuracy".
std::vector<std::string> warnings_of(const std::vector<OdometryEstimate>& estimates, bool poses_given,
                                     const std::optional<std::string>& reason_lost,
                                     const nlohmann::ordered_json& report);

}  // namespace planemap
