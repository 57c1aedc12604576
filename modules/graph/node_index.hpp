// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace planemap::graph {

/// The number of a node (of a tie, ...) as an index: nodes are numbered by int, in which -1 is none.
inline std::size_t at(int number) {
    return static_cast<std::size_t>(number);
}

}  // namespace planemap::graph
