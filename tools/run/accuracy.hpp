// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/trajectory.hpp"

namespace planemap {

class Input;
namespace pipeline {
class Pipeline;
}

/// True if every pose of a trajectory is one of the truth's, at the same time, but for the rounding of text
/// files. Sorted input; false for an empty trajectory.
bool is_part_of(const Trajectory& trajectory, const Trajectory& truth);

/// Adds "accuracy", how far the trajectory is from the truth that lies beside the input, if there is one;
/// figures that the truth does not allow are null. "accuracy_note" says what to know about it, or why there
/// is none: given poses (--poses) are not what was tracked, and if they are the truth itself, nothing is
/// measured.
void add_accuracy(const Input& input, pipeline::Pipeline& pipeline, nlohmann::ordered_json& report);

}  // namespace planemap
