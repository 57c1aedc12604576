// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/camera_file.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/files.hpp"
#include "core/validation.hpp"

namespace planemap {

namespace {

using nlohmann::json;

/// Text of a value for an error message, on one line and not too long.
std::string shown(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 60) + "..." : text;
}

/// Reads fields of one JSON object and collects what is wrong with them.
class Reader {
  public:
    Reader(const json& object, std::string prefix, FieldErrors& errors)
        : object_(object), prefix_(std::move(prefix)), errors_(errors) {}

    bool has(const char* key) const { return object_.contains(key); }

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

    /// A finite number within [low, high]; `fallback` if it is not there and not required.
    double number(const char* key, double low, double high, const char* allowed, bool required,
                  double fallback = 0) const {
        if (!has(key)) {
            if (required) missing(key, allowed);
            return fallback;
        }
        const json& value = object_[key];
        if (value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() >= low &&
            value.get<double>() <= high) {
            return value.get<double>();
        }
        wrong(key, allowed);
        return fallback;
    }

    /// Exactly `count` finite numbers; zeros after an error.
    std::vector<double> numbers(const char* key, std::size_t count) const {
        const std::string allowed = std::to_string(count) + " finite numbers in a list";
        std::vector<double> result;
        if (!has(key)) {
            missing(key, allowed);
        } else if (const json& value = object_[key]; value.is_array() && value.size() == count) {
            for (const json& element : value) {
                if (element.is_number() && std::isfinite(element.get<double>())) {
                    result.push_back(element.get<double>());
                }
            }
        }
        if (has(key) && result.size() != count) wrong(key, allowed);
        result.resize(count, 0.0);
        return result;
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
    const json& object_;
    std::string prefix_;
    FieldErrors& errors_;
};

constexpr double kHuge = 1e6;

PinholeCamera read_pinhole(const Reader& reader) {
    constexpr const char *kSize = "a whole number from 1 to 8192",
                         *kFocal = "a number greater than 0, pixels", *kCentre = "a finite number, pixels";
    const auto size = [&](const char* key) {
        const double value = reader.number(key, 1, 8192, kSize, true, 1);
        if (value != std::floor(value)) reader.wrong(key, kSize);
        return static_cast<int>(value);
    };
    PinholeCamera camera;
    camera.width = size("width");
    camera.height = size("height");
    camera.fx = reader.number("fx", 1e-3, kHuge, kFocal, true, 1);
    camera.fy = reader.number("fy", 1e-3, kHuge, kFocal, true, 1);
    camera.cx = reader.number("cx", -kHuge, kHuge, kCentre, true);
    camera.cy = reader.number("cy", -kHuge, kHuge, kCentre, true);
    return camera;
}

Pose read_transform(const Reader& reader) {
    const auto r = reader.numbers("rotation_vector_rad", 3), t = reader.numbers("translation_m", 3);
    Twist twist;
    twist << t[0], t[1], t[2], r[0], r[1], r[2];
    return pose_from_twist(twist);
}

void read_range(const Reader& reader, CameraInfo& camera) {
    if (!reader.has("depth_range_m")) return;
    const auto range = reader.numbers("depth_range_m", 2);
    if (range[0] >= 0 && range[1] > range[0]) {
        camera.depth_min_m = range[0];
        camera.depth_max_m = range[1];
    } else if (range[0] != 0 || range[1] != 0) {
        reader.wrong("depth_range_m", "[nearest, farthest] in metres with 0 <= nearest < farthest");
    }
}

void read_noise(const Reader& reader, DepthNoise& noise) {
    constexpr const char* kAllowed = "a number of at least 0";
    noise.base_m = reader.number("base_m", 0, 1, kAllowed, false, noise.base_m);
    noise.quadratic_per_m = reader.number("quadratic_per_m", 0, 1, kAllowed, false, noise.quadratic_per_m);
    noise.offset_m = reader.number("offset_m", -100, 100, "a number", false, noise.offset_m);
}

CameraInfo read_camera(const Reader& reader) {
    CameraInfo camera;
    camera.serial = reader.text("serial", 64);
    camera.depth = read_pinhole(reader.object("depth_camera", true));
    camera.registered = reader.boolean("registered", !reader.has("color_from_depth"));
    const bool own_color = reader.has("color_camera") || !camera.registered;
    camera.color = own_color ? read_pinhole(reader.object("color_camera", true)) : camera.depth;
    if (!camera.registered) camera.color_from_depth = read_transform(reader.object("color_from_depth", true));
    camera.depth_units_per_metre = reader.number("depth_units_per_metre", 1e-3, 1e9,
                                                 "a number greater than 0, e.g. 1000 or 5000", true, 1000);
    read_range(reader, camera);
    read_noise(reader.object("noise", false), camera.noise);
    return camera;
}

constexpr const char* kExample =
    R"({"depth_camera": {"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5}, )"
    R"("depth_units_per_metre": 1000, "registered": true})";

}  // namespace

CameraInfo read_camera_file(const std::filesystem::path& file) {
    const std::string bytes = read_file(file, std::size_t{1} << 20);
    const json document = json::parse(bytes, nullptr, false);
    if (!document.is_object()) {
        throw std::invalid_argument(file.string() + ": not a JSON object; a complete example: " + kExample);
    }
    FieldErrors errors(file.string());
    CameraInfo camera = read_camera(Reader(document, "", errors));
    errors.throw_if_any();
    try {
        camera.validate();
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.string() + ": " + error.what());
    }
    return camera;
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

CameraInfo camera_of_folder(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "camera.json";
    std::error_code error;
    if (std::filesystem::exists(file, error)) return read_camera_file(file);
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
