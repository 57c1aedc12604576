// SPDX-License-Identifier: BSD-3-Clause
// zlib streams, by libdeflate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace planemap::messages {

enum class Unzipped {
    kWhole,    ///< the stream filled all of it
    kShort,    ///< it holds less
    kLong,     ///< it holds more
    kCorrupt,  ///< or cut short
};

/// Unpacks a stream that is as long as `bytes`; else what these are is left open.
Unzipped unzip(std::span<const std::uint8_t> zipped, std::span<std::uint8_t> bytes);

/// level: 1 (fast) to 12 (small).
std::vector<std::uint8_t> zip(std::span<const std::uint8_t> bytes, int level);

}  // namespace planemap::messages
