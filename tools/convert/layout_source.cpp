// SPDX-License-Identifier: BSD-3-Clause
#include "convert/layout_source.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "convert/lens_of.hpp"
#include "convert/pixels.hpp"
#include "core/camera_file.hpp"
#include "core/files.hpp"
#include "core/geometry/pose.hpp"
#include "core/json_file.hpp"
#include "core/stamp.hpp"
#include "sensor/image_list.hpp"
#include "sensor/png.hpp"

namespace planemap::convert {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;
using sensor::ListedFrame;
using sensor::ListedImage;

constexpr std::size_t kMaxImageBytes = std::size_t{1} << 28;

bool is_image(const fs::path& file) {
    const std::string end = file.extension();
    return end == ".png" || end == ".jpg" || end == ".jpeg" || end == ".PNG" || end == ".JPG";
}

/// Images of a folder whose names hold `part`, by name.
std::vector<fs::path> images_in(const fs::path& folder, const std::string& part = {}) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
        if (is_image(i->path()) && i->path().filename().string().find(part) != std::string::npos)
            files.push_back(i->path());
    std::sort(files.begin(), files.end());
    return files;
}

struct Images {
    std::vector<fs::path> depth, color;
};

Images find_images(const fs::path& folder) {
    Images images;
    std::error_code ignored;
    if (fs::is_directory(folder / "depth", ignored)) {
        images.depth = images_in(folder / "depth");
        for (const char* name : {"color", "rgb", "image", "colour"})
            if (images.color.empty()) images.color = images_in(folder / name);
    } else {
        images.depth = images_in(folder, "_Depth_");
        images.color = images_in(folder, "_Color_");
    }
    return images;
}

/// The number that a file's name ends with, as it is written; empty if there is none.
std::string number_of(const fs::path& file) {
    const std::string stem = file.stem();
    const std::size_t last = stem.find_last_not_of("0123456789.");
    return last == std::string::npos ? stem : stem.substr(last + 1);
}

/// True for numbers that count images: without a point, and too small for a stamp of this age.
bool is_count(const std::string& number) {
    return number.find('.') == std::string::npos && number.size() <= 8;
}

/// Stamps of images by their names' numbers.
std::vector<ListedImage> listed(const std::vector<fs::path>& files, bool counted, bool in_ms,
                                const LayoutOptions& options) {
    std::vector<ListedImage> images;
    for (const fs::path& file : files) {
        const std::string number = number_of(file);
        std::int64_t utime = 0;
        if (counted) {
            utime = std::llround(std::stod(number.empty() ? "0" : number) / options.rate_hz * 1e6);
        } else {
            const auto stamp = read_stamp(number);
            if (!stamp) throw std::runtime_error(file.string() + ": its name ends with no number or stamp");
            utime = in_ms && stamp->unit == StampUnit::kSeconds ? stamp->utime / 1000 : stamp->utime;
        }
        images.push_back({utime, file});
    }
    std::stable_sort(images.begin(), images.end(),
                     [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return images;
}

/// The camera's files, read with what is assumed of them.
class CameraFiles {
  public:
    CameraFiles(const fs::path& folder, const LayoutOptions& options, std::vector<std::string>& notes)
        : folder_(folder), options_(options), notes_(notes) {}

    CameraInfo read() {
        if (there("camera.json")) return read_camera_file(folder_ / "camera.json", &notes_);
        if (const fs::path both = first_of({"intrinsic.json", "camera_intrinsic.json", "intrinsics.json"});
            !both.empty())
            return aligned(both);
        const fs::path depth =
            first_of({"depth_intrinsic.json", "depth_intrinsics.json", "intrinsic_depth.json"});
        const fs::path color =
            first_of({"color_intrinsic.json", "color_intrinsics.json", "intrinsic_color.json"});
        const fs::path pose = first_of({"extrinsic.json", "extrinsics.json", "depth_to_color.json"});
        if (depth.empty() || (!color.empty() && pose.empty())) {
            throw std::runtime_error(
                folder_.string() +
                ": no file says what its camera is: neither camera.json nor intrinsic.json (depth aligned to "
                "colour) nor "
                "depth_intrinsic.json, color_intrinsic.json and extrinsic.json; give --camera camera.json");
        }
        return unaligned(depth, color, pose);
    }

  private:
    bool there(const std::string& name) const {
        std::error_code ignored;
        return fs::is_regular_file(folder_ / name, ignored);
    }
    fs::path first_of(const std::vector<std::string>& names) const {
        for (const std::string& name : names)
            if (there(name)) return folder_ / name;
        return {};
    }
    CameraInfo aligned(const fs::path& file) {
        CameraInfo camera;
        camera.depth = camera.color = pinhole(file, camera);
        camera.depth_distortion = camera.color_distortion = lens(file);
        notes_.push_back(file.string() +
                         ": assumed: depth is aligned to colour, as Open3D's recorders do it" +
                         units_note(camera));
        return camera;
    }
    CameraInfo unaligned(const fs::path& depth, const fs::path& color, const fs::path& pose) {
        CameraInfo camera;
        camera.depth_units_per_metre = options_.depth_units_per_metre;
        if (!color.empty()) camera.color = pinhole(color, camera);
        camera.depth = pinhole(depth, camera);
        camera.depth_distortion = lens(depth);
        if (color.empty()) {
            camera.color = camera.depth;
            camera.color_distortion = camera.depth_distortion;
        } else {
            camera.color_distortion = lens(color);
            camera.registered = false;
            camera.color_from_depth = transform(pose);
        }
        notes_.push_back(depth.string() + ": assumed: depth as sensed, not aligned to colour" +
                         units_note(camera));
        return camera;
    }
    std::string units_note(const CameraInfo& camera) const {
        char text[80];
        std::snprintf(text, sizeof(text), "; %g units a metre (see --depth-units)",
                      camera.depth_units_per_metre);
        return text;
    }

    static double number(const json& object, const std::vector<const char*>& keys, const fs::path& file) {
        for (const char* key : keys)
            if (object.contains(key) && object[key].is_number()) return object[key].get<double>();
        throw std::invalid_argument(file.string() + ": no number \"" + keys.front() + "\" in it");
    }
    /// Numbers of an array, nested or not, row by row.
    static std::vector<double> numbers(const json& array, const fs::path& file, const char* key) {
        std::vector<double> out;
        for (const json& item : array) {
            const std::vector<double> inner =
                item.is_array() ? numbers(item, file, key) : std::vector<double>{};
            if (item.is_number()) out.push_back(item.get<double>());
            if (!item.is_number() && !item.is_array())
                throw std::invalid_argument(file.string() + ": " + key + " holds what is no number");
            out.insert(out.end(), inner.begin(), inner.end());
        }
        return out;
    }
    PinholeCamera pinhole(const fs::path& file, CameraInfo& camera) {
        const json object = read_json_object(file);
        PinholeCamera out;
        const double width = number(object, {"width"}, file), height = number(object, {"height"}, file);
        if (!(width >= 1 && width <= 100000 && height >= 1 && height <= 100000))
            throw std::invalid_argument(file.string() + ": width and height are those of no image");
        out.width = static_cast<int>(width);
        out.height = static_cast<int>(height);
        if (object.contains("intrinsic_matrix")) {
            const auto m = numbers(object["intrinsic_matrix"], file, "intrinsic_matrix");
            if (m.size() != 9)
                throw std::invalid_argument(file.string() + ": intrinsic_matrix has no 9 numbers");
            const bool by_rows = object["intrinsic_matrix"].front().is_array();
            out.fx = m[0], out.fy = m[4], out.cx = by_rows ? m[2] : m[6], out.cy = by_rows ? m[5] : m[7];
        } else {
            out.fx = number(object, {"fx"}, file), out.fy = number(object, {"fy"}, file);
            out.cx = number(object, {"cx", "ppx"}, file), out.cy = number(object, {"cy", "ppy"}, file);
        }
        camera.depth_units_per_metre = options_.depth_units_per_metre;
        if (object.contains("depth_scale")) {  // units a metre (Open3D) or metres a unit (RealSense)
            const double scale = number(object, {"depth_scale"}, file);
            if (scale > 0) camera.depth_units_per_metre = scale < 1 ? std::round(1e3 / scale) / 1e3 : scale;
        }
        return out;
    }
    /// "coeffs" and "model" as RealSense's SDK names them, or "distortion"; without a model brown, which the
    /// note says.
    std::optional<LensDistortion> lens(const fs::path& file) {
        const json object = read_json_object(file);
        for (const char* key : {"coeffs", "distortion"}) {
            if (!object.contains(key) || !object[key].is_array()) continue;
            const bool is_named = object.contains("model") && object["model"].is_string();
            const SaidLens said =
                lens_of(is_named ? object["model"].get<std::string>() : "", numbers(object[key], file, key));
            if (!said.note.empty()) notes_.push_back(file.string() + ": " + said.note);
            if (said.lens && !is_named)
                notes_.push_back(file.string() + ": assumed: its distortion is of the model of Brown");
            return said.lens;
        }
        return std::nullopt;
    }
    Pose transform(const fs::path& file) {
        const json object = read_json_object(file);
        const auto fail = [&](const char* what) { throw std::invalid_argument(file.string() + ": " + what); };
        Eigen::Matrix3d rotation;
        Eigen::Vector3d translation;
        if (object.contains("matrix")) {
            const auto m = numbers(object["matrix"], file, "matrix");
            if (m.size() != 16 && m.size() != 12) fail("matrix has not four rows of four numbers");
            using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
            const Eigen::Map<const Rows> rows(m.data());
            rotation = rows.leftCols<3>();
            translation = rows.col(3);
        } else {
            if (!object.contains("rotation") || !object.contains("translation"))
                fail("neither matrix nor rotation and translation in it");
            const auto r = numbers(object["rotation"], file, "rotation");
            const auto t = numbers(object["translation"], file, "translation");
            if (r.size() != 9 || t.size() != 3) fail("rotation has 9 numbers, translation 3");
            rotation = Eigen::Map<const Eigen::Matrix3d>(r.data());  // column by column
            if (object["rotation"].front().is_array()) rotation.transposeInPlace();
            translation = {t[0], t[1], t[2]};
        }
        if (!rotation.allFinite() || !translation.allFinite() ||
            (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() > 0.01 ||
            rotation.determinant() < 0)
            fail("its rotation is none");
        if (translation.norm() > 1) {
            translation *= 1e-3;
            notes_.push_back(file.string() +
                             ": assumed: its translation is in millimetres, as Azure Kinect's SDK has it");
        }
        notes_.push_back(file.string() +
                         ": assumed: it takes points of the depth camera to the colour camera");
        return make_pose(translation, Eigen::Quaterniond(rotation).normalized());
    }

    fs::path folder_;
    const LayoutOptions& options_;
    std::vector<std::string>& notes_;
};

class LayoutSource : public FrameSource {
  public:
    LayoutSource(const fs::path& folder, const LayoutOptions& options) {
        const Images images = find_images(folder);
        if (images.depth.empty()) throw std::runtime_error(folder.string() + ": no depth images in it");
        const auto all_counted = [](const std::vector<fs::path>& files) {
            return std::all_of(files.begin(), files.end(),
                               [](const fs::path& f) { return is_count(number_of(f)); });
        };
        const bool counted = all_counted(images.depth) && all_counted(images.color);
        const bool in_ms = images.depth.front().parent_path() == folder;
        const std::int64_t gap_us = counted ? 0 : std::llround(options.max_color_gap_s * 1e6);
        const auto color = listed(images.color, counted, in_ms, options);
        frames_ = sensor::associate(listed(images.depth, counted, in_ms, options), color, gap_us);
        if (counted) {
            char text[80];
            std::snprintf(text, sizeof(text), ": assumed: numbered images are taken at %g Hz (see --rate)",
                          options.rate_hz);
            notes_.push_back(folder.string() + text);
        }
        const std::string left = sensor::left_over(frames_, color, gap_us);
        if (!left.empty()) notes_.push_back(folder.string() + ": " + left);
        camera_ = options.camera ? *options.camera : CameraFiles(folder, options, notes_).read();
    }

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return frames_.size(); }
    std::vector<std::string> notes() const override { return notes_; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        if (next_ == frames_.size()) return {};
        const ListedFrame& listed = frames_[next_++];
        ReadResult result;
        result.status = ReadResult::Status::kFrame;
        try {
            frame.depth = sensor::decode_depth_png(read_file(listed.depth.file, kMaxImageBytes),
                                                   camera_.depth.width, camera_.depth.height);
            frame.utime = listed.depth.utime;
        } catch (const std::exception& error) {
            result.status = ReadResult::Status::kBroken;
            blame(listed.depth.file, error, "; the frame is left out", result);
            return result;
        }
        if (!listed.color) return result;
        try {
            const std::string bytes = read_file(listed.color->file, kMaxImageBytes);
            read_compressed_color({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                                  camera_.color, frame);
            frame.color_utime = listed.color->utime;
        } catch (const std::exception& error) {
            result.color_left_out = true;
            blame(listed.color->file, error, "; the frame is used without colour", result);
        }
        return result;
    }

  private:
    static void blame(const fs::path& file, const std::exception& error, const char* fate,
                      ReadResult& result) {
        result.reason = error.what();
        const std::string prefix = file.string() + ": ";
        if (result.reason.starts_with(prefix)) result.reason.erase(0, prefix.size());
        result.message = prefix + result.reason + fate;
    }

    std::vector<std::string> notes_;
    CameraInfo camera_;
    std::vector<ListedFrame> frames_;
    std::size_t next_ = 0;
};

}  // namespace

bool is_camera_layout(const fs::path& folder) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) return false;
    for (const char* list : {"depth.txt", "associations.txt"})
        if (fs::exists(folder / list, ignored)) return false;
    return !find_images(folder).depth.empty();
}

std::unique_ptr<FrameSource> open_layout(const fs::path& folder, const LayoutOptions& options) {
    return std::make_unique<LayoutSource>(folder, options);
}

}  // namespace planemap::convert
