// SPDX-License-Identifier: BSD-3-Clause
#include "report_page/point_file.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "core/files.hpp"
#include "core/text_file.hpp"

namespace planemap {

namespace {

constexpr std::size_t kMostStoredPoints = 5'000'000;
constexpr std::size_t kMostBytes = std::size_t{256} << 20;
constexpr std::size_t kLongestHeader = std::size_t{64} << 10;

static_assert(std::endian::native == std::endian::little, "points.ply is little-endian, and copied as it is");

const std::map<std::string, std::size_t> kBytesOfType = {
    {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
    {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
    {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};

/// A property that we read, by its name: where it lies in a vertex, once the header said so.
struct Wanted {
    const char* name;
    std::array<const char*, 2> types;  ///< the two names of its type
    std::optional<std::size_t> offset;
};

struct Layout {
    std::size_t points = 0, stride = 0, start = 0;
    std::array<Wanted, 7> wanted{{{"x", {"float", "float32"}, {}},
                                  {"y", {"float", "float32"}, {}},
                                  {"z", {"float", "float32"}, {}},
                                  {"red", {"uchar", "uint8"}, {}},
                                  {"green", {"uchar", "uint8"}, {}},
                                  {"blue", {"uchar", "uint8"}, {}},
                                  {"plane", {"int", "int32"}, {}}}};
};

[[noreturn]] void fail(const std::string& why) {
    throw std::runtime_error(why);
}

void add_property(const std::string& type, const std::string& name, Layout& layout) {
    const auto bytes = kBytesOfType.find(type);
    if (bytes == kBytesOfType.end()) fail("a property of type " + shown_text(type) + ", which is not known");
    for (Wanted& wanted : layout.wanted) {
        if (wanted.name != name) continue;
        if (wanted.types[0] != type && wanted.types[1] != type)
            fail(name + " is " + shown_text(type) + ", not " + wanted.types[0]);
        wanted.offset = layout.stride;
    }
    layout.stride += bytes->second;
}

std::size_t point_count(const std::string& text) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size())
        fail("vertex " + shown_text(text) + " is no number of points");
    if (count > kMostStoredPoints)
        fail(std::to_string(count) + " points, more than the " + std::to_string(kMostStoredPoints) +
             " that are read");
    return count;
}

/// One line of the header; false at its end.
bool read_line(const std::string& line, Layout& layout, int& element) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "end_header") return false;
    if (first == "format" && second != "binary_little_endian")
        fail("is " + shown_text(second) + ", not binary_little_endian");
    if (first == "element" && ++element == 1) {
        if (second != "vertex") fail("its first element is " + shown_text(second) + ", not vertex");
        layout.points = point_count(third);
    } else if (first == "property" && element == 1) {
        add_property(second, third, layout);
    }
    return true;
}

Layout layout_of(const std::string& bytes) {
    if (!bytes.starts_with("ply\n")) fail("is no PLY file");
    Layout layout;
    int element = 0;
    for (std::size_t at = 4; at < std::min(bytes.size(), kLongestHeader);) {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string::npos) break;
        const bool goes_on =
            read_line(bytes.substr(at, std::min(end - at, std::size_t{200})), layout, element);
        at = end + 1;
        if (goes_on) continue;
        for (const Wanted& wanted : layout.wanted)
            if (!wanted.offset) fail(std::string("has no property ") + wanted.name);
        layout.start = at;
        return layout;
    }
    fail("its header has no end");
}

template <typename T>
T value_at(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof(value));
    return value;
}

std::vector<CloudPoint> points_of(const std::string& bytes) {
    const Layout layout = layout_of(bytes);
    if ((bytes.size() - layout.start) / layout.stride < layout.points) fail("is cut short");
    const auto offset = [&](std::size_t i) { return *layout.wanted[i].offset; };
    std::vector<CloudPoint> points;
    points.reserve(layout.points);
    for (std::size_t i = 0; i < layout.points; ++i) {
        const char* vertex = bytes.data() + layout.start + i * layout.stride;
        CloudPoint point;
        for (std::size_t k = 0; k < 3; ++k)
            point.position[static_cast<Eigen::Index>(k)] = value_at<float>(vertex + offset(k));
        if (!point.position.allFinite()) continue;
        const auto color = [&](std::size_t k) { return value_at<std::uint8_t>(vertex + offset(k)); };
        point.color = {color(3), color(4), color(5)};
        point.plane = value_at<std::int32_t>(vertex + offset(6));
        points.push_back(point);
    }
    return points;
}

}  // namespace

std::vector<CloudPoint> read_points(const std::filesystem::path& file) {
    const std::string bytes = read_file(file, kMostBytes);
    try {
        return points_of(bytes);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(file.string() + ": " + error.what());
    }
}

}  // namespace planemap
