// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace planemap::benchmark {

/// Frames of one round of a simulated world's tour; throws std::invalid_argument for another input, or a walk
/// that is no tour.
std::int64_t frames_a_round(const std::string& simulator_name);

}  // namespace planemap::benchmark
