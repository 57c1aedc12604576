// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/image_list.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "core/stamp.hpp"
#include "core/text_file.hpp"
#include "core/time_step.hpp"

namespace planemap::sensor {

namespace fs = std::filesystem;

namespace {

constexpr const char* kBlanks = " \t\v\f";
constexpr const char* kImageLine = "`timestamp filename`";
constexpr const char* kPairLine =
    "`timestamp rgb-file timestamp depth-file` or the other way round, with \"depth\" in one file's name "
    "only";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of(kBlanks), text.size());
    text.remove_prefix(first);
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Calls use(line) for each line that is not blank or a comment, and puts file and number before what it
/// throws.
template <typename Use>
void for_each_line(const fs::path& file, const Use& use) {
    const std::string text = read_text_file(file);
    std::string_view rest = text;
    for (int number = 1; !rest.empty(); ++number) {
        const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
        const std::string_view line = trimmed(rest.substr(0, end));
        const bool two = rest.substr(end).starts_with("\r\n");
        rest.remove_prefix(std::min(end + (two ? 2 : 1), rest.size()));
        if (line.empty() || line.starts_with('#')) continue;
        try {
            use(line);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + error.what());
        }
    }
}

[[noreturn]] void refuse(std::string_view line, const char* expected) {
    throw std::runtime_error(std::string("expected ") + expected + ", not \"" + shown_text(line) + "\"");
}

/// A stamp and what stands behind it, without the blanks or the comma between.
std::pair<std::string_view, std::string_view> split_stamp(std::string_view line) {
    const std::size_t end = std::min(line.find_first_of(" \t\v\f,"), line.size());
    std::string_view rest = trimmed(line.substr(end));
    if (rest.starts_with(',')) rest = trimmed(rest.substr(1));
    return {line.substr(0, end), rest};
}

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// The name in what stands behind a stamp: all of it, unless only its first word is a file.
std::string name_in(const fs::path& folder, std::string_view text) {
    const std::size_t blank = text.find_first_of(kBlanks);
    if (blank == std::string_view::npos || is_file(folder / text)) return std::string(text);
    return std::string(is_file(folder / text.substr(0, blank)) ? text.substr(0, blank) : text);
}

/// A line of a list of pairs, cut up.
struct Pair {
    std::string_view stamps[2], files[2];
};

/// Cuts `stamp file stamp file`: files may hold blanks, so the second stamp is a word that reads as one; of
/// several such words the one that leaves two files that exist.
std::optional<Pair> cut_pair(const fs::path& folder, std::string_view line) {
    std::optional<Pair> first;
    Pair pair;
    std::string_view rest;
    std::tie(pair.stamps[0], rest) = split_stamp(line);
    for (std::size_t at = rest.find_first_of(kBlanks); at < rest.size();
         at = rest.find_first_of(kBlanks, at)) {
        at = rest.find_first_not_of(kBlanks, at);
        std::tie(pair.stamps[1], pair.files[1]) = split_stamp(rest.substr(at));
        pair.files[0] = trimmed(rest.substr(0, at));
        if (pair.files[1].empty() || !read_stamp(pair.stamps[1])) continue;
        if (!first) first = pair;
        if (is_file(folder / pair.files[0]) && is_file(folder / pair.files[1])) return pair;
    }
    return first;
}

bool names_depth(std::string_view file) {
    return file.find("depth") != std::string_view::npos;
}

std::int64_t time_of(const ListedImage& image) {
    return image.utime;
}
std::int64_t time_of(const ListedFrame& frame) {
    return frame.depth.utime;
}
const fs::path& file_of(const ListedImage& image) {
    return image.file;
}
const fs::path& file_of(const ListedFrame& frame) {
    return frame.depth.file;
}

std::string gap_text(std::int64_t us) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.6g s", static_cast<double>(us) * 1e-6);
    return text;
}

/// Throws unless the median step between the sorted entries is one that a camera makes.
template <typename Entry>
void check_step(const std::vector<Entry>& entries, const std::string& unit, const fs::path& file) {
    constexpr std::int64_t kLeastUs = 1000, kMostUs = 60000000;
    if (entries.size() < 2) return;
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < entries.size(); ++i) {
        steps.push_back(time_of(entries[i]) - time_of(entries[i - 1]));
    }
    const std::int64_t median_us = median_step(steps);
    if (median_us >= kLeastUs && median_us <= kMostUs) return;
    throw std::runtime_error(
        file.string() + ": the median step between its timestamps is " + gap_text(median_us) +
        " if they are in " + unit +
        ", as their size says (over 1e11 milliseconds, over 1e14 microseconds, over 1e17 nanoseconds, else "
        "seconds); a camera's is 1 ms to 60 s: write them in seconds");
}

/// Sorts by time, leaves each moment once, and notes what it did.
template <typename Entry>
void put_in_order(List<Entry>& list, const std::string& unit, const fs::path& file) {
    auto& entries = list.entries;
    const auto note = [&](std::size_t count, const char* what) {
        if (count > 0) list.notes.push_back(file.string() + ": " + std::to_string(count) + what);
    };
    if (!entries.empty() && unit != unit_name(StampUnit::kSeconds)) {
        list.notes.push_back(file.string() + ": by their size, the timestamps are read as " + unit);
    }
    std::size_t late = 0;
    std::int64_t newest = std::numeric_limits<std::int64_t>::min();
    for (const Entry& entry : entries) {
        if (time_of(entry) < newest) ++late;
        newest = std::max(newest, time_of(entry));
    }
    note(late, " lines are out of order; they are sorted by time");
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return time_of(a) < time_of(b); });
    const auto drop = [&](const auto& same, const char* what) {
        const auto end = std::unique(entries.begin(), entries.end(), same);
        note(static_cast<std::size_t>(entries.end() - end), what);
        entries.erase(end, entries.end());
    };
    drop([](const Entry& a, const Entry& b) { return time_of(a) == time_of(b) && file_of(a) == file_of(b); },
         " lines repeat another; each is used once");
    check_step(entries, unit, file);
    drop([](const Entry& a, const Entry& b) { return time_of(a) == time_of(b); },
         " lines have the timestamp of another; the first of each is used");
}

std::string unit_text(const StampColumn& stamps) {
    return unit_name(stamps.unit().value_or(StampUnit::kSeconds));
}

/// Microseconds between a depth image without colour and the nearest colour image; nothing without either.
std::optional<std::int64_t> nearest_gap(const std::vector<ListedFrame>& frames,
                                        const std::vector<ListedImage>& color) {
    std::optional<std::int64_t> nearest;
    std::size_t j = 0;
    for (const ListedFrame& frame : frames) {
        if (frame.color) continue;
        while (j < color.size() && color[j].utime < frame.depth.utime) ++j;
        for (const std::size_t i : {j, j - 1}) {
            if (i >= color.size()) continue;
            const std::int64_t gap = std::llabs(color[i].utime - frame.depth.utime);
            if (!nearest || gap < *nearest) nearest = gap;
        }
    }
    return nearest;
}

}  // namespace

List<ListedImage> read_image_list(const fs::path& file) {
    List<ListedImage> list;
    StampColumn stamps;
    for_each_line(file, [&](std::string_view line) {
        const auto [stamp, rest] = split_stamp(line);
        if (rest.empty()) refuse(line, kImageLine);
        list.entries.push_back({stamps.read(stamp), name_in(file.parent_path(), rest)});
    });
    put_in_order(list, unit_text(stamps), file);
    return list;
}

List<ListedFrame> read_associations(const fs::path& file) {
    List<ListedFrame> list;
    StampColumn depth_stamps, color_stamps;
    for_each_line(file, [&](std::string_view line) {
        const std::optional<Pair> pair = cut_pair(file.parent_path(), line);
        if (!pair || names_depth(pair->files[0]) == names_depth(pair->files[1])) refuse(line, kPairLine);
        const int depth = names_depth(pair->files[0]) ? 0 : 1, color = 1 - depth;
        list.entries.push_back({{depth_stamps.read(pair->stamps[depth]), pair->files[depth]},
                                ListedImage{color_stamps.read(pair->stamps[color]), pair->files[color]}});
    });
    put_in_order(list, unit_text(depth_stamps), file);
    return list;
}

std::vector<ListedFrame> associate(const std::vector<ListedImage>& depth,
                                   const std::vector<ListedImage>& color, std::int64_t max_gap_us) {
    std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> pairs;  // gap, depth, colour
    std::size_t low = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        while (low < color.size() && color[low].utime < depth[i].utime - max_gap_us) ++low;
        for (std::size_t j = low; j < color.size() && color[j].utime <= depth[i].utime + max_gap_us; ++j) {
            pairs.emplace_back(std::llabs(color[j].utime - depth[i].utime), i, j);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<ListedFrame> frames;
    frames.reserve(depth.size());
    for (const ListedImage& image : depth) frames.push_back({image, std::nullopt});
    std::vector<bool> taken(color.size(), false);
    for (const auto& [gap, i, j] : pairs) {
        if (frames[i].color || taken[j]) continue;
        frames[i].color = color[j];
        taken[j] = true;
    }
    return frames;
}

std::string left_over(const std::vector<ListedFrame>& frames, const std::vector<ListedImage>& color,
                      std::int64_t max_gap_us) {
    const auto paired = static_cast<std::size_t>(std::count_if(
        frames.begin(), frames.end(), [](const auto& frame) { return frame.color.has_value(); }));
    const std::size_t alone = frames.size() - paired, unused = color.size() - paired;
    std::string text;
    if (alone > 0) {
        text = std::to_string(alone) + " of " + std::to_string(frames.size()) +
               " depth images have no colour image of their own within " + gap_text(max_gap_us);
        const auto gap = nearest_gap(frames, color);
        if (gap && *gap > max_gap_us) text += " (the nearest is " + gap_text(*gap) + " away)";
        text += "; those frames are used without colour";
    }
    if (unused > 0) {
        text += (text.empty() ? "" : "; ") + std::to_string(unused) + " of " + std::to_string(color.size()) +
                " colour images belong to no depth image and are not used";
    }
    return text;
}

}  // namespace planemap::sensor
