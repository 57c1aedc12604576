// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_planes.hpp"

#include <optional>

namespace planemap::map {

namespace {

void put(std::vector<std::uint8_t>& bytes, int value) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
}

std::optional<int> take(std::span<const std::uint8_t>& bytes) {
    if (bytes.size() < 4) return std::nullopt;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) bits = bits << 8 | bytes[i];
    bytes = bytes.subspan(4);
    return static_cast<int>(bits);
}

}  // namespace

std::vector<std::uint8_t> encode_region_planes(const std::map<int, std::vector<int>>& planes) {
    std::vector<std::uint8_t> bytes;
    for (const auto& [keyframe, of_regions] : planes) {
        put(bytes, keyframe);
        put(bytes, static_cast<int>(of_regions.size()));
        for (const int plane : of_regions) put(bytes, plane);
    }
    return bytes;
}

std::map<int, std::vector<int>> decode_region_planes(std::span<const std::uint8_t> bytes) {
    std::map<int, std::vector<int>> planes;
    for (;;) {
        const std::optional<int> keyframe = take(bytes), count = take(bytes);
        if (!count || *count < 0 || static_cast<std::size_t>(*count) > bytes.size() / 4) return planes;
        std::vector<int>& of_regions = planes[*keyframe];
        for (int i = 0; i < *count; ++i) of_regions.push_back(*take(bytes));
    }
}

}  // namespace planemap::map
