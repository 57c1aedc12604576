// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace planemap::octomap {

/// INPUT POSES [resolution=0.05] [every n-th frame=10]: prints what a depth image of INPUT costs at its pose
/// (a trajectory file of the colour camera), in CPU time of the thread, beside OctoMap's own insertion.
/// Returns the exit code: 1 when the trees differ.
int insertion_benchmark(const std::vector<std::string>& arguments);

}  // namespace planemap::octomap
