// SPDX-License-Identifier: BSD-3-Clause
#include "core/camera_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/joined.hpp"
#include "core/json_file.hpp"
#include "core/lens_distortion.hpp"
#include "core/nearest_name.hpp"
#include "core/number_text.hpp"
#include "core/sensor_preset.hpp"
#include "core/text_file.hpp"
#include "core/validation.hpp"

namespace planemap {

namespace {

using nlohmann::json;

/// Text of a value for an error message, on one line and not too long.
std::string shown(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    return shown_text(text, 60);
}

/// What a number may be.
struct Bounds {
    double low, high;
    const char* unit = "";  ///< with its blank, e.g. " pixels"
    const char* kind = "a number";

    bool hold(double value) const { return std::isfinite(value) && value >= low && value <= high; }
    std::string text() const {
        return std::string(kind) + " from " + short_number_text(low) + " to " + short_number_text(high) +
               unit;
    }
};

/// Reads fields of one JSON object and collects what is wrong with them.
class Reader {
  public:
    Reader(const json& object, std::string prefix, FieldErrors& errors)
        : object_(object), prefix_(std::move(prefix)), errors_(errors) {}

    bool has(const char* key) const { return object_.contains(key); }

    /// An error for each key that is none of `known`, with the nearest one that is.
    void require_known(const std::vector<std::string>& known) const {
        constexpr std::size_t kMostNamed = 8;
        std::size_t unknown = 0;
        for (const auto& [key, unused] : object_.items()) {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            if (++unknown > kMostNamed) continue;
            const std::string nearest = nearest_name(key, known);
            errors_.require(false, prefix_ + key_text(key), "not a known key",
                            nearest.empty() ? "one of " + joined(known) : nearest);
        }
        if (unknown > kMostNamed) {
            errors_.require(false, prefix_ + "...",
                            std::to_string(unknown - kMostNamed) + " more unknown keys", "left out");
        }
    }

    /// The object under `key`; an empty one, and an error if it is required, when there is none.
    Reader object(const char* key, bool required) const {
        static const json kNone = json::object();
        if (has(key) && object_[key].is_object()) return {object_[key], prefix_ + key + ".", errors_};
        if (has(key)) {
            wrong(key, "an object");
        } else if (required) {
            missing(key, "an object");
        }
        return {kNone, prefix_ + key + ".", errors_};
    }

    /// A number within the bounds; `fallback` if it is not there and not required.
    double number(const char* key, const Bounds& bounds, bool required, double fallback = 0) const {
        if (!has(key)) {
            if (required) missing(key, bounds.text());
            return fallback;
        }
        const json& value = object_[key];
        if (value.is_number() && bounds.hold(value.get<double>())) return value.get<double>();
        wrong(key, bounds.text());
        return fallback;
    }

    /// Exactly `count` numbers within the bounds; nothing after an error.
    std::optional<std::vector<double>> numbers(const char* key, std::size_t count,
                                               const Bounds& bounds) const {
        const std::string allowed = "a list of " + std::to_string(count) + ", each " + bounds.text();
        std::vector<double> result;
        if (!has(key)) {
            missing(key, allowed);
        } else if (const json& value = object_[key]; value.is_array() && value.size() == count) {
            for (const json& element : value) {
                if (element.is_number() && bounds.hold(element.get<double>())) {
                    result.push_back(element.get<double>());
                }
            }
        }
        if (has(key) && result.size() != count) wrong(key, allowed);
        if (result.size() != count) return {};
        return result;
    }

    /// Of a list; nothing if there is none.
    std::optional<std::size_t> size_of(const char* key) const {
        if (!has(key) || !object_[key].is_array()) return std::nullopt;
        return object_[key].size();
    }

    bool boolean(const char* key, bool fallback) const {
        if (!has(key)) return fallback;
        if (object_[key].is_boolean()) return object_[key].get<bool>();
        wrong(key, "true or false");
        return fallback;
    }

    std::string text(const char* key, std::size_t longest) const {
        if (!has(key)) return {};
        if (object_[key].is_string() && object_[key].get_ref<const std::string&>().size() <= longest) {
            return object_[key].get<std::string>();
        }
        wrong(key, "a text of at most " + std::to_string(longest) + " characters");
        return {};
    }

    void wrong(const char* key, const std::string& allowed) const {
        errors_.require(false, prefix_ + key, shown(object_[key]), allowed);
    }
    void missing(const char* key, const std::string& allowed) const {
        errors_.require(false, prefix_ + key, "missing", allowed);
    }

  private:
    /// A key in a message: as it is if it is a plain word.
    static std::string key_text(const std::string& key) {
        const bool plain = !key.empty() && key.size() <= 40 &&
                           std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c < 0x7f; });
        return plain ? key : shown(key);
    }

    const json& object_;
    std::string prefix_;
    FieldErrors& errors_;
};

constexpr const char* kDistortion = "distortion";
constexpr const char* kAccelerometer = "camera_from_accelerometer";

PinholeCamera read_pinhole(const Reader& reader) {
    reader.require_known({"width", "height", "fx", "fy", "cx", "cy", kDistortion});
    constexpr Bounds kSize{1, 8192, "", "a whole number"};
    const auto size = [&](const char* key) {
        const double value = reader.number(key, kSize, true, 640);
        if (value != std::floor(value)) reader.wrong(key, kSize.text());
        return static_cast<int>(value);
    };
    PinholeCamera camera;
    camera.width = size("width");
    camera.height = size("height");
    using Limits = CameraLimits;
    const double longer = std::max(camera.width, camera.height);
    const Bounds focal{Limits::kLeastFocal * longer, Limits::kMostFocal * longer, " pixels"};
    const auto centre = [](double side) {
        return Bounds{-Limits::kOutside * side, (1 + Limits::kOutside) * side, " pixels"};
    };
    camera.fx = reader.number("fx", focal, true, 1);
    camera.fy = reader.number("fy", focal, true, 1);
    camera.cx = reader.number("cx", centre(camera.width), true);
    camera.cy = reader.number("cy", centre(camera.height), true);
    return camera;
}

/// All numbers of a list, or nothing after an error; `allowed` says what it may be.
std::optional<std::vector<double>> read_coefficients(const Reader& reader, LensDistortion::Model model) {
    constexpr const char* kKey = "coefficients";
    constexpr Bounds kAny{-1e6, 1e6};
    std::string counts;
    for (const std::size_t count : coefficient_counts(model))
        counts += (counts.empty() ? "" : " or ") + std::to_string(count);
    const std::string allowed = "a list of " + counts + " for " + name_of(model) + ", each " + kAny.text();
    for (const std::size_t count : coefficient_counts(model))
        if (reader.size_of(kKey) == count) return reader.numbers(kKey, count, kAny);
    reader.has(kKey) ? reader.wrong(kKey, allowed) : reader.missing(kKey, allowed);
    return std::nullopt;
}

/// Of the camera that `reader` reads.
std::optional<LensDistortion> read_distortion(const Reader& reader) {
    if (!reader.has(kDistortion)) return std::nullopt;
    const Reader inner = reader.object(kDistortion, true);
    inner.require_known({"model", "coefficients"});
    const auto model = distortion_model(inner.text("model", 64));
    if (!model) {
        inner.has("model") ? inner.wrong("model", "brown or fisheye")
                           : inner.missing("model", "brown or fisheye");
        return std::nullopt;
    }
    const auto coefficients = read_coefficients(inner, *model);
    if (!coefficients) return std::nullopt;
    return LensDistortion{*model, *coefficients};
}

constexpr double kFarthestMount_m = 20;  // of a camera from its robot's origin
constexpr double kFarthestCamera_m = 2;  // of one camera from the other

Pose read_transform(const Reader& reader, double farthest_m) {
    reader.require_known({"rotation_vector_rad", "translation_m"});
    const auto r = reader.numbers("rotation_vector_rad", 3, {-6.2832, 6.2832, " rad"});
    const auto t = reader.numbers("translation_m", 3, {-farthest_m, farthest_m, " m"});
    if (!r || !t) return Pose::Identity();
    Twist twist;
    twist << (*t)[0], (*t)[1], (*t)[2], (*r)[0], (*r)[1], (*r)[2];
    return pose_from_twist(twist);
}

Eigen::Matrix3d read_rotation(const Reader& reader) {
    reader.require_known({"rotation_vector_rad"});
    const auto r = reader.numbers("rotation_vector_rad", 3, {-6.2832, 6.2832, " rad"});
    Twist twist = Twist::Zero();
    if (r) twist.tail<3>() << (*r)[0], (*r)[1], (*r)[2];
    return pose_from_twist(twist).linear();
}

/// What is known of the kind of sensor, which the file's own range and noise then replace.
void read_sensor(const Reader& reader, CameraInfo& camera) {
    if (!reader.has("sensor")) return;
    const std::string name = reader.text("sensor", 64);
    const SensorPreset* preset = find_sensor_preset(name);
    if (preset == nullptr) {
        const std::vector<std::string> names = sensor_preset_names();
        const std::string nearest = nearest_name(name, names);
        reader.wrong("sensor",
                     "one of " + joined(names) + (nearest.empty() ? "" : "; the nearest is " + nearest));
        return;
    }
    camera.depth_min_m = preset->depth_min_m;
    camera.depth_max_m = preset->depth_max_m;
    camera.noise = preset->noise;
}

void read_range(const Reader& reader, CameraInfo& camera) {
    if (!reader.has("depth_range_m")) return;
    constexpr double kFarthest = 100;
    const auto range = reader.numbers("depth_range_m", 2, {0, kFarthest, " m"});
    if (!range) return;
    camera.depth_min_m = range->front();
    camera.depth_max_m = range->back();
    if (camera.depth_max_m <= camera.depth_min_m) {
        reader.wrong("depth_range_m", "[nearest, farthest] in metres with 0 <= nearest < farthest");
    }
}

void read_noise(const Reader& reader, DepthNoise& noise) {
    reader.require_known({"base_m", "quadratic_per_m", "offset_m"});
    noise.base_m = reader.number("base_m", {0, 1, " m"}, false, noise.base_m);
    noise.quadratic_per_m = reader.number("quadratic_per_m", {0, 1, " per m"}, false, noise.quadratic_per_m);
    noise.offset_m = reader.number("offset_m", {-10, 10, " m"}, false, noise.offset_m);
}

std::optional<DepthCorrection> read_correction(const Reader& reader) {
    if (!reader.has("depth_correction")) return std::nullopt;
    const Reader inner = reader.object("depth_correction", true);
    inner.require_known({"offsets_per_m", "sigmas_per_m"});
    constexpr double kMost = DepthCorrection::kMost_per_m;
    DepthCorrection correction;
    const auto take = [&](const char* key, double least, std::array<double, DepthCorrection::kNodes>& into) {
        const auto numbers = inner.numbers(key, into.size(), {least, kMost, " per m"});
        if (numbers) std::copy(numbers->begin(), numbers->end(), into.begin());
    };
    take("offsets_per_m", -kMost, correction.offsets);
    if (inner.has("sigmas_per_m")) take("sigmas_per_m", 0, correction.sigmas);
    return correction;
}

void read_units(const Reader& reader, CameraInfo& camera) {
    constexpr Bounds kUnits{CameraLimits::kLeastUnits, CameraLimits::kMostUnits, ", e.g. 1000 or 5000"};
    camera.depth_units_per_metre = reader.number("depth_units_per_metre", kUnits, true, 1000);
}

/// What stands in the file and is not used.
std::vector<std::string> unused_keys(const Reader& reader, const CameraInfo& camera) {
    if (camera.registered && reader.has("color_from_depth")) return {"color_from_depth (registered is true)"};
    return {};
}

/// Both cameras, each with its lens.
void read_cameras(const Reader& reader, CameraInfo& camera) {
    if (reader.has(kDistortion)) reader.wrong(kDistortion, "within depth_camera or color_camera");
    const Reader depth = reader.object("depth_camera", true);
    camera.depth = camera.color = read_pinhole(depth);
    camera.depth_distortion = camera.color_distortion = read_distortion(depth);
    if (reader.has("color_camera") || !camera.registered) {
        const Reader color = reader.object("color_camera", true);
        camera.color = read_pinhole(color);
        camera.color_distortion = read_distortion(color);
    }
}

CameraInfo read_camera(const Reader& reader) {
    reader.require_known({"sensor", "serial", "depth_camera", "color_camera", "registered",
                          "color_from_depth", "depth_units_per_metre", "depth_range_m", "noise", "poses_of",
                          "depth_correction", "note", "body_from_camera", kAccelerometer, kDistortion});
    CameraInfo camera;
    camera.serial = reader.text("serial", 64);
    camera.registered = reader.boolean("registered", !reader.has("color_from_depth"));
    read_cameras(reader, camera);
    if (!camera.registered || reader.has("color_from_depth")) {
        const Pose color_from_depth =
            read_transform(reader.object("color_from_depth", true), kFarthestCamera_m);
        if (!camera.registered) camera.color_from_depth = color_from_depth;
    }
    if (reader.has("body_from_camera"))
        camera.body_from_camera = read_transform(reader.object("body_from_camera", true), kFarthestMount_m);
    read_sensor(reader, camera);
    read_range(reader, camera);
    read_units(reader, camera);
    read_noise(reader.object("noise", false), camera.noise);
    camera.depth_correction = read_correction(reader);
    if (reader.has(kAccelerometer)) read_rotation(reader.object(kAccelerometer, true));
    reader.text("note", 10000);
    const std::string poses_of = reader.text("poses_of", 64);
    if (reader.has("poses_of") && poses_of != "color_camera") {
        reader.wrong("poses_of", "color_camera: groundtruth.txt holds poses of the colour camera");
    }
    return camera;
}

constexpr const char* kExample =
    R"({"depth_camera": {"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5}, )"
    R"("depth_units_per_metre": 1000, "registered": true})";

nlohmann::ordered_json camera_json(const PinholeCamera& camera, const std::optional<LensDistortion>& lens) {
    nlohmann::ordered_json json = {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
                                   {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
    if (lens) json[kDistortion] = {{"model", name_of(lens->model)}, {"coefficients", lens->coefficients}};
    return json;
}

nlohmann::ordered_json transform_json(const Pose& transform) {
    const Eigen::AngleAxisd rotation(transform.linear());
    const Eigen::Vector3d r = rotation.angle() * rotation.axis(), t = transform.translation();
    return {{"rotation_vector_rad", {r.x(), r.y(), r.z()}}, {"translation_m", {t.x(), t.y(), t.z()}}};
}

nlohmann::ordered_json correction_json(const DepthCorrection& correction) {
    return {{"offsets_per_m", correction.offsets}, {"sigmas_per_m", correction.sigmas}};
}

}  // namespace

std::string with_depth_correction(const std::filesystem::path& file, const DepthCorrection& correction) {
    json document = read_json_object(file);
    document["depth_correction"] = correction_json(correction);
    return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string camera_file_text(const CameraInfo& camera) {
    nlohmann::ordered_json file;
    if (!camera.serial.empty()) file["serial"] = camera.serial;
    file["depth_camera"] = camera_json(camera.depth, camera.depth_distortion);
    if (!camera.registered || !(camera.color == camera.depth) ||
        camera.color_distortion != camera.depth_distortion)
        file["color_camera"] = camera_json(camera.color, camera.color_distortion);
    file["depth_units_per_metre"] = camera.depth_units_per_metre;
    file["registered"] = camera.registered;
    if (!camera.registered) file["color_from_depth"] = transform_json(camera.color_from_depth);
    if (camera.body_from_camera) file["body_from_camera"] = transform_json(*camera.body_from_camera);
    file["depth_range_m"] = {camera.depth_min_m, camera.depth_max_m};
    file["noise"] = {{"base_m", camera.noise.base_m},
                     {"quadratic_per_m", camera.noise.quadratic_per_m},
                     {"offset_m", camera.noise.offset_m}};
    if (camera.depth_correction) file["depth_correction"] = correction_json(*camera.depth_correction);
    return file.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

CameraInfo read_camera_file(const std::filesystem::path& file, std::vector<std::string>* notes) {
    json document;
    try {
        document = read_json_object(file);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(std::string(error.what()) + "; a complete example: " + kExample);
    }
    FieldErrors errors(file.string());
    const Reader reader(document, "", errors);
    CameraInfo camera = read_camera(reader);
    errors.throw_if_any();
    try {
        camera.validate();
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.string() + ": " + error.what());
    }
    const std::vector<std::string> unused = unused_keys(reader, camera);
    if (notes != nullptr && !unused.empty()) {
        notes->push_back(file.string() + ": known, but not used: " + joined(unused));
    }
    return camera;
}

Eigen::Matrix3d camera_from_accelerometer(const std::filesystem::path& camera_file) {
    std::error_code error;
    if (std::filesystem::exists(camera_file, error) || error) {
        const json document = read_json_object(camera_file);
        FieldErrors errors(camera_file.string());
        const Reader reader(document, "", errors);
        if (reader.has(kAccelerometer)) {
            Eigen::Matrix3d rotation = read_rotation(reader.object(kAccelerometer, true));
            errors.throw_if_any();
            return rotation;
        }
    }
    return Eigen::Vector3d(-1, -1, 1).asDiagonal();
}

std::optional<CameraInfo> tum_camera(std::string_view folder_name) {
    CameraInfo camera;
    if (folder_name.find("freiburg1") != std::string_view::npos) {
        camera.depth = {640, 480, 517.3, 516.5, 318.6, 255.3};
        camera.serial = "TUM freiburg1";
    } else if (folder_name.find("freiburg2") != std::string_view::npos) {
        camera.depth = {640, 480, 520.9, 521.0, 325.1, 249.7};
        camera.serial = "TUM freiburg2";
    } else if (folder_name.find("freiburg3") != std::string_view::npos) {
        camera.depth = {640, 480, 535.4, 539.2, 320.1, 247.6};
        camera.serial = "TUM freiburg3";
    } else {
        return std::nullopt;
    }
    camera.color = camera.depth;
    camera.depth_units_per_metre = 5000;
    return camera;
}

CameraInfo camera_of_folder(const std::filesystem::path& folder, std::vector<std::string>* notes) {
    const std::filesystem::path file = folder / "camera.json";
    std::error_code error;
    if (std::filesystem::exists(file, error) || error) return read_camera_file(file, notes);
    std::filesystem::path named = std::filesystem::weakly_canonical(folder, error);
    if (!named.has_filename()) named = named.parent_path();
    if (auto camera = tum_camera(named.filename().string())) return *camera;
    throw std::runtime_error(
        file.string() +
        ": missing, and the folder is not one of the TUM benchmark's (freiburg1, 2 or 3 in its name); "
        "write the camera's data there, for example: " +
        kExample);
}

}  // namespace planemap
