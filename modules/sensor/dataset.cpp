// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "core/files.hpp"
#include "sensor/camera_file.hpp"
#include "sensor/jpeg.hpp"
#include "sensor/png.hpp"

namespace planemap {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxImageBytes = std::size_t{1} << 28;

/// Seconds as text to microseconds; nothing unless the text is a finite number of a plausible size.
std::optional<std::int64_t> parse_utime(const std::string& text) {
    char* end = nullptr;
    const long double seconds = std::strtold(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(seconds) || std::fabs(seconds) > 1e12L) return {};
    return std::llround(seconds * 1e6L);
}

/// Calls use(number, fields) for each line that is not blank or a comment; a false return is a bad line.
template <typename Use>
void for_each_line(const fs::path& file, const char* expected, const Use& use) {
    std::istringstream in(read_file(file));
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::istringstream words(line);
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty() || fields[0].starts_with('#')) continue;
        if (!use(fields)) {
            throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": expected " + expected);
        }
    }
}

bool names_depth(const std::string& file) {
    return file.find("depth") != std::string::npos;
}

/// The reason with the file in front, unless the reason names it already.
std::string with_file(const fs::path& file, const std::exception& error) {
    const std::string reason = error.what();
    return reason.starts_with(file.string()) ? reason : file.string() + ": " + reason;
}

/// Frames of the folder: its associations, or its lists associated.
std::vector<ListedFrame> list_frames(const fs::path& folder, const SourceOptions& options) {
    if (!fs::is_directory(folder)) {
        throw std::runtime_error(folder.string() +
                                 (fs::exists(folder) ? ": not a folder" : ": no such folder"));
    }
    if (fs::exists(folder / "associations.txt")) return read_associations(folder / "associations.txt");
    if (!fs::exists(folder / "depth.txt")) {
        throw std::runtime_error(folder.string() +
                                 ": neither depth.txt nor associations.txt: not a folder in the TUM layout");
    }
    std::vector<ListedImage> color;
    if (fs::exists(folder / "rgb.txt")) color = read_image_list(folder / "rgb.txt");
    return associate(read_image_list(folder / "depth.txt"), color,
                     std::llround(options.max_color_gap_s * 1e6));
}

}  // namespace

std::vector<ListedImage> read_image_list(const fs::path& file) {
    std::vector<ListedImage> images;
    for_each_line(file, "`timestamp filename`", [&](const std::vector<std::string>& fields) {
        if (fields.size() < 2) return false;
        const auto utime = parse_utime(fields[0]);
        if (utime) images.push_back({*utime, fields[1]});
        return utime.has_value();
    });
    std::stable_sort(images.begin(), images.end(),
                     [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return images;
}

std::vector<ListedFrame> read_associations(const fs::path& file) {
    std::vector<ListedFrame> frames;
    constexpr const char* kExpected =
        "`timestamp rgb-file timestamp depth-file` or the other way round, with \"depth\" in one file's name "
        "only";
    for_each_line(file, kExpected, [&](const std::vector<std::string>& fields) {
        if (fields.size() < 4 || names_depth(fields[1]) == names_depth(fields[3])) return false;
        const auto first = parse_utime(fields[0]), second = parse_utime(fields[2]);
        if (!first || !second) return false;
        const ListedImage a{*first, fields[1]}, b{*second, fields[3]};
        frames.push_back(names_depth(fields[1]) ? ListedFrame{a, b} : ListedFrame{b, a});
        return true;
    });
    std::stable_sort(frames.begin(), frames.end(),
                     [](const auto& a, const auto& b) { return a.depth.utime < b.depth.utime; });
    return frames;
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
    for (const ListedImage& image : depth) frames.push_back({image, std::nullopt});
    std::vector<bool> taken(color.size(), false);
    for (const auto& [gap, i, j] : pairs) {
        if (frames[i].color || taken[j]) continue;
        frames[i].color = color[j];
        taken[j] = true;
    }
    return frames;
}

Dataset::Dataset(const fs::path& folder, const SourceOptions& options)
    : folder_(folder), frames_(list_frames(folder, options)) {
    if (frames_.empty()) throw std::runtime_error(folder.string() + ": its lists name no depth images");
    camera_ = camera_of_folder(folder);
    const auto [from, to] = frames_within(options.frames, frames_.size());
    frames_ = {frames_.begin() + static_cast<std::ptrdiff_t>(from),
               frames_.begin() + static_cast<std::ptrdiff_t>(to)};
}

ReadResult Dataset::next(SensorFrame& frame) {
    frame = {};
    if (next_ == frames_.size()) return {ReadResult::Status::kEnd, ""};
    const ListedFrame& listed = frames_[next_++];
    const fs::path depth_file = folder_ / listed.depth.file;
    try {
        frame.depth = decode_depth_png(read_file(depth_file, kMaxImageBytes), camera_.depth.width,
                                       camera_.depth.height);
        frame.utime = listed.depth.utime;
    } catch (const std::exception& error) {
        return {ReadResult::Status::kBroken, with_file(depth_file, error)};
    }
    if (!listed.color) return {ReadResult::Status::kFrame, ""};
    const fs::path color_file = folder_ / listed.color->file;
    try {
        read_color(*listed.color, frame);
    } catch (const std::exception& error) {
        return {ReadResult::Status::kFrame,
                with_file(color_file, error) + "; the frame is used without colour"};
    }
    return {ReadResult::Status::kFrame, ""};
}

void Dataset::read_color(const ListedImage& image, SensorFrame& frame) const {
    const std::string bytes = read_file(folder_ / image.file, kMaxImageBytes);
    if (is_png(bytes)) {
        frame.color = decode_color_png(bytes, camera_.color.width, camera_.color.height);
    } else if (is_jpeg(bytes)) {
        check_jpeg(bytes, camera_.color.width, camera_.color.height);
        frame.color_jpeg.assign(bytes.begin(), bytes.end());
    } else {
        throw std::runtime_error("neither a PNG nor a JPEG");
    }
    frame.color_utime = image.utime;
}

}  // namespace planemap
