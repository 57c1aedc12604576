// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "graph/options.hpp"
#include "places/verification_options.hpp"

namespace planemap::graph {

/// What the graph's options say of when two views show the same.
places::VerificationOptions verification_options(const GraphOptions& options);

}  // namespace planemap::graph
