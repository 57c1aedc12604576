// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/camera_file.hpp"
#include "core/files.hpp"
#include "core/text_file.hpp"
#include "sensor/accelerometer_file.hpp"
#include "sensor/jpeg.hpp"
#include "sensor/png.hpp"

namespace planemap::sensor {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxImageBytes = std::size_t{1} << 28;

/// True for a link that leads nowhere, too: to read it says why.
bool stands(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

bool holds_lists(const fs::path& folder) {
    return stands(folder / "depth.txt") || stands(folder / "associations.txt");
}

/// A folder just below that has the lists, as archives unpack to; empty if there is none.
fs::path folder_below(const fs::path& folder) {
    std::set<fs::path> below;  // in order of name, whatever the file system's
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        if (holds_lists(i->path())) below.insert(i->path());
    }
    return below.empty() ? fs::path() : *below.begin();
}

/// Throws unless there is a folder with the lists.
void require_lists(const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (!fs::exists(status)) {
        const bool missing = status.type() == fs::file_type::not_found;
        throw std::runtime_error(folder.string() + ": " + (missing ? "no such folder" : error.message()));
    }
    if (!fs::is_directory(status)) throw std::runtime_error(folder.string() + ": not a folder");
    if (holds_lists(folder)) return;
    if (fs::directory_iterator(folder, error); error) {
        throw std::runtime_error(folder.string() + ": cannot be read: " + error.message());
    }
    const fs::path below = folder_below(folder);
    throw std::runtime_error(
        folder.string() + ": neither depth.txt nor associations.txt: not a folder in the TUM layout" +
        (below.empty() ? std::string("; a line of depth.txt is `timestamp depth/name.png`")
                       : "; " + below.string() + " is one"));
}

/// How many images of a list the pairs leave out, in a line; empty if none.
std::string left_out(const fs::path& folder, const char* list, const std::set<fs::path>& used) {
    if (!stands(folder / list)) return {};
    std::size_t count = 0;
    const auto images = read_image_list(folder / list).entries;
    for (const ListedImage& image : images) count += used.count(image.file) == 0 ? 1 : 0;
    if (count == 0) return {};
    return (folder / "associations.txt").string() + ": leaves out " + std::to_string(count) + " of the " +
           std::to_string(images.size()) + " images of " + list;
}

/// The pairs that the folder gives, with a note of what they leave out.
std::vector<ListedFrame> given_pairs(const fs::path& folder, std::vector<std::string>& notes) {
    auto list = read_associations(folder / "associations.txt");
    notes.insert(notes.end(), list.notes.begin(), list.notes.end());
    std::set<fs::path> depth, color;
    for (const ListedFrame& frame : list.entries) {
        depth.insert(frame.depth.file);
        color.insert(frame.color->file);
    }
    for (const auto& [name, used] : {std::pair{"depth.txt", &depth}, std::pair{"rgb.txt", &color}}) {
        try {
            if (const std::string text = left_out(folder, name, *used); !text.empty()) notes.push_back(text);
        } catch (const std::runtime_error& error) {
            notes.push_back(std::string(error.what()) + "; associations.txt is used, this list is not");
        }
    }
    return list.entries;
}

/// Frames of the folder: its associations, or its lists associated.
std::vector<ListedFrame> list_frames(const fs::path& folder, const SourceOptions& options,
                                     std::vector<std::string>& notes) {
    require_lists(folder);
    if (stands(folder / "associations.txt")) return given_pairs(folder, notes);
    const auto depth = read_image_list(folder / "depth.txt");
    List<ListedImage> color;
    if (stands(folder / "rgb.txt")) {
        color = read_image_list(folder / "rgb.txt");
    } else {
        color.notes.push_back((folder / "rgb.txt").string() + ": missing; the frames have no colour");
    }
    notes.insert(notes.end(), depth.notes.begin(), depth.notes.end());
    notes.insert(notes.end(), color.notes.begin(), color.notes.end());
    const std::int64_t max_gap_us = std::llround(options.max_color_gap_s * 1e6);
    auto frames = associate(depth.entries, color.entries, max_gap_us);
    const std::string left = left_over(frames, color.entries, max_gap_us);
    if (!left.empty() && stands(folder / "rgb.txt")) notes.push_back(folder.string() + ": " + left);
    return frames;
}

/// What is wrong with a file: the reason alone, and with the file before it.
void blame(const fs::path& file, const std::exception& error, ReadResult& result) {
    constexpr std::size_t kLongest = 400;
    result.reason = shown_text(error.what(), kLongest);
    const std::string prefix = shown_text(file.string(), kLongest) + ": ";
    if (result.reason.starts_with(prefix)) result.reason.erase(0, prefix.size());
    result.message = prefix + result.reason;
}

void blame_end(const fs::path& file, ReadResult& result) {
    result.end_missing = true;
    if (!result.message.empty()) return;  // of the colour, which is worse
    blame(file, std::runtime_error(kEndMissing), result);
}

}  // namespace

Dataset::Dataset(const fs::path& folder, const SourceOptions& options)
    : folder_(folder), frames_(list_frames(folder, options, notes_)) {
    if (frames_.empty()) throw std::runtime_error(folder.string() + ": its lists name no depth images");
    camera_ = options.camera ? *options.camera : camera_of_folder(folder, &notes_);
    const auto [from, to] = frames_within(options.frames, frames_.size());
    frames_ = {frames_.begin() + static_cast<std::ptrdiff_t>(from),
               frames_.begin() + static_cast<std::ptrdiff_t>(to)};
    read_accelerometer();
}

/// One that cannot be read is left out: frames are worth more.
void Dataset::read_accelerometer() {
    const fs::path file = folder_ / "accelerometer.txt";
    if (!stands(file)) return;
    try {
        accelerations_ = read_accelerometer_file(file, camera_from_accelerometer(folder_ / "camera.json"));
    } catch (const std::exception& error) {
        notes_.push_back(std::string(error.what()) + "; the accelerometer is not used");
        return;
    }
    // Of the time before the first frame, what may still be of that one's.
    constexpr std::int64_t kBefore_us = 1000000;
    const auto first = std::partition_point(
        accelerations_.begin(), accelerations_.end(),
        [&](const Acceleration& a) { return a.utime < frames_.front().depth.utime - kBefore_us; });
    next_acceleration_ = static_cast<std::size_t>(first - accelerations_.begin());
}

ReadResult Dataset::next(SensorFrame& frame) {
    frame = {};
    if (next_ == frames_.size()) return {};
    const ListedFrame& listed = frames_[next_++];
    std::vector<Acceleration> accelerations;
    for (; next_acceleration_ < accelerations_.size(); ++next_acceleration_) {
        if (accelerations_[next_acceleration_].utime > listed.depth.utime) break;
        accelerations.push_back(accelerations_[next_acceleration_]);
    }
    ReadResult result;
    result.status = ReadResult::Status::kFrame;
    bool depth_whole = true, color_whole = true;
    try {
        depth_whole = read_depth(listed.depth, frame);
    } catch (const std::exception& error) {
        frame = {};
        result.status = ReadResult::Status::kBroken;
        blame(folder_ / listed.depth.file, error, result);
        result.message += "; the frame is left out";
        return result;
    }
    if (listed.color) {
        try {
            color_whole = read_color(*listed.color, frame);
        } catch (const std::exception& error) {
            blame(folder_ / listed.color->file, error, result);
            result.color_left_out = true;
            result.message += "; the frame is used without colour";
        }
    }
    frame.accelerations = std::move(accelerations);
    if (!depth_whole) blame_end(folder_ / listed.depth.file, result);
    if (!color_whole) blame_end(folder_ / listed.color->file, result);
    return result;
}

/// Reads a depth image into the frame; false if its file is cut short behind the pixels.
bool Dataset::read_depth(const ListedImage& image, SensorFrame& frame) const {
    bool end_missing = false;
    frame.depth = decode_depth_png(read_file(folder_ / image.file, kMaxImageBytes), camera_.depth.width,
                                   camera_.depth.height, &end_missing);
    frame.utime = image.utime;
    return !end_missing;
}

/// The same for colour.
bool Dataset::read_color(const ListedImage& image, SensorFrame& frame) const {
    const std::string bytes = read_file(folder_ / image.file, kMaxImageBytes);
    bool end_missing = false;
    if (is_png(bytes)) {
        frame.color = decode_color_png(bytes, camera_.color.width, camera_.color.height, &end_missing);
    } else if (is_jpeg(bytes)) {
        check_jpeg(bytes, camera_.color.width, camera_.color.height);
        frame.color_jpeg.assign(bytes.begin(), bytes.end());
    } else {
        throw std::runtime_error("neither a PNG nor a JPEG");
    }
    frame.color_utime = image.utime;
    return !end_missing;
}

}  // namespace planemap::sensor
