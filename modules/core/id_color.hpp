// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/image.hpp"

namespace planemap {

/// A colour that tells ids apart, neighbouring ones above all; the same in exports, pictures and viewers.
Rgb id_color(int id);

}  // namespace planemap
