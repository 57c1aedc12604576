// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace planemap {

/// Frames of an input, counted from 0, broken ones included: from `from` to the one before `to`.
struct FrameRange {
    std::size_t from = 0;
    std::optional<std::size_t> to;  ///< nothing: to the end

    bool is_all() const { return from == 0 && !to; }
};

/// Reads "A:B"; either end may be left out. Throws std::invalid_argument, one line, for anything else and for
/// a range without a frame.
FrameRange parse_frame_range(const std::string& text);

/// The range's part of an input of `size` frames: first frame and the one after the last. Throws
/// std::invalid_argument, one line, when there is none.
std::pair<std::size_t, std::size_t> frames_within(const FrameRange& range, std::size_t size);

}  // namespace planemap
