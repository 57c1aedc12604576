// SPDX-License-Identifier: BSD-3-Clause
// What a result was made on.
#pragma once

#include <optional>
#include <string>

namespace planemap {

/// The name of this computer; nothing if it has none.
std::optional<std::string> host_name();

/// The processor's name as the kernel tells it; nothing where it tells none, as on some ARM boards.
std::optional<std::string> cpu_model();

}  // namespace planemap
