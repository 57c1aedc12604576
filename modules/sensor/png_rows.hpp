// SPDX-License-Identifier: BSD-3-Clause
// The usual PNG, fast: inflated at once by libdeflate, filters taken back row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace planemap::sensor {

/// Bytes of a chunk that is read.
inline constexpr std::size_t kMaxPngChunk = std::size_t{1} << 24;

/// A PNG's pixels as they are in the file.
struct PngFormat {
    int width = 0, height = 0;
    int bit_depth = 0, color_type = 0;  ///< as the header has them
    int bytes_per_pixel = 0;
    std::size_t row_bytes() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(bytes_per_pixel);
    }
};

/// Decodes the pixels of a PNG of this format, not interlaced and without a palette, into height rows of
/// row_bytes(), samples of 16 bits most significant byte first. True if the file is whole: every chunk's
/// checksum holds, the stream ends with the last pixel, and so does the file with its end marker. False for
/// all others, good or bad; `rows` is undefined then. Throws std::invalid_argument if `rows` is not of that
/// size.
bool decode_png_rows(std::string_view bytes, const PngFormat& format, std::span<std::uint8_t> rows);

/// Takes a row's filter (0 to 4, PNG specification section 9) back. `above` is the row before as it is
/// without its filter, zeros for the first. Both have the same length. Another filter: false.
bool unfilter_row(int filter, int bytes_per_pixel, std::span<std::uint8_t> row,
                  std::span<const std::uint8_t> above);

}  // namespace planemap::sensor
