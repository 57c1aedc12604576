// SPDX-License-Identifier: BSD-3-Clause
// Strict PNG reading: all pixels or an error, never a part of them.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "core/image.hpp"

namespace planemap::sensor {

/// Longest side of an image that is read.
inline constexpr int kMaxImageSide = 8192;

/// True when the bytes start as a PNG does.
bool is_png(std::string_view bytes);

/// What is said of a file that is cut short where no pixel is lost: it is used all the same.
inline constexpr const char* kEndMissing = "the PNG is cut short, but behind its last pixel; it is used";

/// Decodes a 16-bit greyscale PNG. Throws std::runtime_error (reason only) for anything else: another type or
/// bit depth, a size other than width x height, a checksum that does not hold, a file cut short. With
/// `end_missing`, a file that is cut short behind its last pixel is no error: it is set to whether that is
/// so.
DepthImage decode_depth_png(std::string_view bytes, int width, int height, bool* end_missing = nullptr);

/// Decodes an 8-bit RGB, RGBA, greyscale or palette PNG to RGB (alpha is dropped). Throws as
/// decode_depth_png().
RgbImage decode_color_png(std::string_view bytes, int width, int height, bool* end_missing = nullptr);

/// Writes a 16-bit greyscale PNG. Throws std::runtime_error naming the file.
void write_depth_png(const std::filesystem::path& file, const DepthImage& depth);

/// Writes an 8-bit RGB PNG. Throws std::runtime_error naming the file.
void write_color_png(const std::filesystem::path& file, const RgbImage& color);

}  // namespace planemap::sensor
