// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <libdeflate.h>

#include <stdexcept>

#include "fuzz/fuzz.hpp"

namespace planemap::fuzz {

/// The PNG with checksums that hold, so that what is behind them is reached.
inline std::string with_png_checksums(std::string_view bytes) {
    std::string png(bytes);
    const auto byte = [&](std::size_t at) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(png[at]));
    };
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::size_t length = byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
        if (length > png.size() - at - 12) break;
        const std::uint32_t sum = libdeflate_crc32(0, png.data() + at + 4, length + 4);
        for (std::size_t i = 0; i < 4; ++i) png[at + 8 + length + i] = static_cast<char>(sum >> (24 - 8 * i));
        at += length + 12;
    }
    return png;
}

/// Decodes with `decode(bytes, width, height, end_missing)` as a folder's reader does, once as it is and once
/// with checksums that hold.
template <typename Decode>
void fuzz_png(Bytes bytes, const Decode& decode) {
    constexpr int kWidth = 16, kHeight = 12;
    for (const std::string& png : {std::string(as_text(bytes)), with_png_checksums(as_text(bytes))}) {
        bool missing = false;
        for (bool* const end_missing : {static_cast<bool*>(nullptr), &missing}) {
            try {
                const auto image = decode(png, kWidth, kHeight, end_missing);
                require(image.width == kWidth && image.height == kHeight, "the size is as asked for");
            } catch (const std::runtime_error&) {
            }
        }
    }
}

}  // namespace planemap::fuzz
