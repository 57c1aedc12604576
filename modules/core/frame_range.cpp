// SPDX-License-Identifier: BSD-3-Clause
#include "core/frame_range.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace planemap {

namespace {

std::string text_of(const FrameRange& range) {
    return "\"" + std::to_string(range.from) + ":" + (range.to ? std::to_string(*range.to) : "") + "\"";
}

}  // namespace

FrameRange parse_frame_range(const std::string& text) {
    const auto fail = [&](const std::string& why) {
        throw std::invalid_argument(
            "frames \"" + text + "\": " + why +
            "; A:B takes frames A to B-1, counted from 0, and either may be left out");
    };
    const auto colon = text.find(':');
    if (colon == std::string::npos) fail("no colon in it");
    const auto number = [&](const std::string& part) -> std::optional<std::size_t> {
        if (part.empty()) return std::nullopt;
        std::size_t value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size())
            fail("\"" + part + "\" is no whole number from 0 on");
        return value;
    };
    const FrameRange range{number(text.substr(0, colon)).value_or(0), number(text.substr(colon + 1))};
    if (range.to && *range.to <= range.from) fail("no frame lies in it");
    return range;
}

std::pair<std::size_t, std::size_t> frames_within(const FrameRange& range, std::size_t size) {
    if (range.from > 0 && range.from >= size) {
        throw std::invalid_argument("frames " + text_of(range) + ": the input has only " +
                                    std::to_string(size) + ", numbered from 0");
    }
    return {range.from, std::min(range.to.value_or(size), size)};
}

}  // namespace planemap
