// SPDX-License-Identifier: BSD-3-Clause
// The lists of a folder in the layout of the TUM RGB-D benchmark: which image was taken when.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace planemap::sensor {

/// One line of rgb.txt or depth.txt.
struct ListedImage {
    std::int64_t utime = 0;      ///< microseconds
    std::filesystem::path file;  ///< relative to the folder
};

/// A depth image and the colour image that belongs to it.
struct ListedFrame {
    ListedImage depth;
    std::optional<ListedImage> color;
};

/// What a list says, in order of time, each moment once.
template <typename Entry>
struct List {
    std::vector<Entry> entries;
    std::vector<std::string> notes;  ///< a line each of what the user should know: repeated stamps and so on
};

/// Reads a list of `timestamp filename` lines: stamps as read_stamp() reads them, all in one unit; a name may
/// hold blanks. A byte order mark, any line ends, blanks around, blank lines and # comments are skipped; a
/// comma may stand behind the stamp. Lines out of order are sorted; of lines with the same stamp the first
/// counts; both are noted. Throws std::runtime_error naming file and reason, and the line, for a line that is
/// none of these; and when the median step between the stamps is not within 1 ms to 60 s: then they are in
/// another unit than their size says, or no stamps.
List<ListedImage> read_image_list(const std::filesystem::path& file);

/// Reads a list of `timestamp file timestamp file` lines, depth and colour in either order (told apart by
/// "depth" in the file's name), in order of depth time. Otherwise as read_image_list().
List<ListedFrame> read_associations(const std::filesystem::path& file);

/// Pairs images as the TUM benchmark's associate.py does: of all pairs within max_gap_us the nearest first,
/// each image once. Every depth image is in the result, in order of time.
std::vector<ListedFrame> associate(const std::vector<ListedImage>& depth,
                                   const std::vector<ListedImage>& color, std::int64_t max_gap_us);

/// What associate() left over, in one line; empty if every image has its partner.
std::string left_over(const std::vector<ListedFrame>& frames, const std::vector<ListedImage>& color,
                      std::int64_t max_gap_us);

}  // namespace planemap::sensor
