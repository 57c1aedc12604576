// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace planemap::sensor {

/// True when the bytes start as a JPEG does.
bool is_jpeg(std::string_view bytes);

/// A cheap check that the JPEG can be passed on undecoded: a header that reads, the size width x height, and
/// the end marker in place, so that it was not cut short. Throws std::runtime_error (reason only) otherwise.
/// Damage within the compressed data shows only when it is decoded.
void check_jpeg(std::string_view bytes, int width, int height);

}  // namespace planemap::sensor
