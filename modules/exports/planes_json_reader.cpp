// SPDX-License-Identifier: BSD-3-Clause
#include "exports/planes_json_reader.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/json_file.hpp"
#include "core/number_text.hpp"
#include "core/stamp.hpp"
#include "core/text_file.hpp"

namespace planemap::exports {

namespace {

using nlohmann::json;

constexpr std::size_t kLargest = std::size_t{32} << 20;  // bytes
constexpr double kFarthest_m = 1e6;                      // from the world's origin
constexpr double kUnitError = 1e-3;                      // of a unit vector's length
constexpr double kOff_m = 0.01, kOffRelative = 1e-6;     // of what lies on a plane, and of its coordinates

/// A value of the file and where it stands, for one line that says what is wrong with it.
class Field {
  public:
    Field(const json& value, std::string at) : value_(value), at_(std::move(at)) {}

    [[noreturn]] void refuse(const std::string& allowed) const {
        constexpr std::size_t kShown = 60;
        const std::string text =
            shown_text(value_.dump(-1, ' ', false, json::error_handler_t::replace), kShown);
        throw std::invalid_argument(at_ + " is " + text + "; allowed: " + allowed);
    }

    std::optional<Field> find(const char* key) const {
        if (!value_.is_object()) refuse("an object");
        const auto at = value_.find(key);
        if (at == value_.end()) return std::nullopt;
        return Field(*at, at_.empty() ? key : at_ + "." + key);
    }
    Field operator[](const char* key) const {
        const auto field = find(key);
        if (!field) throw std::invalid_argument((at_.empty() ? "" : at_ + ".") + key + " is missing");
        return *field;
    }
    bool is_null() const { return value_.is_null(); }
    std::size_t size() const {
        if (!value_.is_array()) refuse("a list");
        return value_.size();
    }
    Field element(std::size_t i) const { return {value_[i], at_ + "[" + std::to_string(i) + "]"}; }

    double number(double low, double high) const {
        if (!value_.is_number() || !(value_.get<double>() >= low && value_.get<double>() <= high))
            refuse("a number from " + short_number_text(low) + " to " + short_number_text(high));
        return value_.get<double>();
    }
    double number_or_unknown() const {
        return is_null() ? std::numeric_limits<double>::quiet_NaN()
                         : number(0, static_cast<double>(std::numeric_limits<float>::max()));
    }
    std::int64_t integer(std::int64_t low, std::int64_t high) const {
        const bool fits =
            value_.is_number_integer() &&
            !(value_.is_number_unsigned() && value_.get<std::uint64_t>() > std::uint64_t{1} << 62);
        if (!fits || value_.get<std::int64_t>() < low || value_.get<std::int64_t>() > high)
            refuse("a whole number from " + std::to_string(low) + " to " + std::to_string(high));
        return value_.get<std::int64_t>();
    }
    Eigen::Vector3d position() const {
        if (!value_.is_array() || value_.size() != 3) refuse("three numbers");
        Eigen::Vector3d p;
        for (std::size_t i = 0; i < 3; ++i)
            p[static_cast<int>(i)] = element(i).number(-kFarthest_m, kFarthest_m);
        return p;
    }
    Eigen::Vector3d unit_vector() const {
        const Eigen::Vector3d v = position();
        if (std::abs(v.norm() - 1) > kUnitError) refuse("a unit vector");
        return v.normalized();
    }
    template <typename OneOf>
    auto one_of(const OneOf& values, const char* (*name)(typename OneOf::value_type)) const {
        std::string names;
        for (const auto value : values) {
            if (value_.is_string() && value_.get_ref<const std::string&>() == name(value)) return value;
            names += (names.empty() ? "" : ", ") + std::string(name(value));
        }
        refuse("one of " + names);
    }

  private:
    const json& value_;
    std::string at_;
};

constexpr std::array kLabels{PlaneLabel::kUnknown, PlaneLabel::kFloor,      PlaneLabel::kCeiling,
                             PlaneLabel::kWall,    PlaneLabel::kHorizontal, PlaneLabel::kOther,
                             PlaneLabel::kVertical};

/// Rings of points of the world in the frame of a plane, z along its normal.
Outline rings_of(const Field& field, const Pose& world_from_plane) {
    const Pose plane_from_world = world_from_plane.inverse(Eigen::Isometry);
    Outline outline;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Field points = field.element(i);
        if (points.size() < 3 || points.size() > kMaxRingVertices)
            points.refuse("3 to " + std::to_string(kMaxRingVertices) + " points");
        Ring& ring = outline.rings.emplace_back();
        for (std::size_t j = 0; j < points.size(); ++j) {
            const Eigen::Vector3d p_world = points.element(j).position();
            const Eigen::Vector3d p = plane_from_world * p_world;
            if (std::abs(p.z()) > kOff_m + kOffRelative * p_world.norm())
                points.element(j).refuse("a point of the plane");
            ring.emplace_back(p.head<2>());
        }
    }
    return outline;
}

/// From one corner of the box to a neighbour; nothing where its thickness, and so no corner, is known.
std::optional<Eigen::Vector3d> side_of(const Field& corners, std::size_t neighbour) {
    if (corners.size() != 8) corners.refuse("8 points");
    if (corners.element(0).size() == 3 && corners.element(0).element(0).is_null()) return std::nullopt;
    return corners.element(neighbour).position() - corners.element(0).position();
}

Eigen::Vector3d long_side(const Field& corners) {
    return side_of(corners, 1).value_or(Eigen::Vector3d::Zero());
}

/// Of the box; where that is not known, of what bounds the outline.
Eigen::Vector3d half_extents(const Field& corners, const Outline& outline) {
    const auto x = side_of(corners, 1), y = side_of(corners, 2);
    if (x && y) return {0.5 * x->norm(), 0.5 * y->norm(), 0};
    Eigen::Vector3d half = Eigen::Vector3d::Zero();
    for (const Ring& ring : outline.rings)
        for (const Eigen::Vector2d& v : ring) half.head<2>() = half.head<2>().cwiseMax(v.cwiseAbs());
    return half;
}

/// Puts the plane, and what is inferred of it, into the map.
void add_plane(const Field& field, PlaneMap& map) {
    const auto id = static_cast<int>(field["id"].integer(0, std::numeric_limits<std::int32_t>::max()));
    if (!map.planes.empty() && id <= map.planes.back().id) field["id"].refuse("ascending ids, each once");
    PlanarRegion region;
    region.plane.normal = field["normal"].unit_vector();
    const Eigen::Vector3d center = field["center"].position();
    region.plane.d = field["d"].number(-2 * kFarthest_m, 2 * kFarthest_m);
    if (std::abs(region.plane.signed_distance(center)) > kOff_m + kOffRelative * center.norm())
        field["d"].refuse("that of a plane through center");
    region.rms = field["rms"].number_or_unknown();
    region.box.frame_from_box.linear() = plane_axes(region.plane.normal, long_side(field["box_corners"]));
    region.box.frame_from_box.translation() = region.plane.project(center);
    region.moments.count = field["inliers"].number_or_unknown();
    region.outline = rings_of(field["outline"], region.box.frame_from_box);
    region.box.half_extents = half_extents(field["box_corners"], region.outline);
    const auto keyframes = field.find("keyframe_count");
    MapPlane& plane = map.planes.emplace_back(
        id, region, static_cast<std::size_t>(keyframes ? keyframes->integer(0, 32767) : 0));
    plane.label = field["label"].one_of(kLabels, label_name);
    plane.area = static_cast<float>(field["area"].number_or_unknown());
    if (const auto inferred = field.find("inferred_rings"))
        map.inferred.push_back({id, MapOutline(rings_of(*inferred, plane.world_from_plane()))});
}

/// Ids of planes that are in the map, ascending.
template <std::size_t count>
std::array<int, count> ids_of(const Field& field, const PlaneMap& map) {
    if (field.size() != count) field.refuse(std::to_string(count) + " ids");
    std::array<int, count> ids;
    for (std::size_t i = 0; i < count; ++i) {
        ids[i] = static_cast<int>(field.element(i).integer(0, std::numeric_limits<std::int32_t>::max()));
        if (map.find(ids[i]) == nullptr) field.element(i).refuse("the id of a plane");
        if (i > 0 && ids[i] <= ids[i - 1]) field.refuse("ascending ids");
    }
    return ids;
}

PlaneMap map_of(const Field& document) {
    PlaneMap map;
    map.utime = document["utime"].integer(-kFarthestUtime, kFarthestUtime);
    map.revision =
        static_cast<int>(document["revision"].integer(0, std::numeric_limits<std::int32_t>::max()));
    if (!document["up"].is_null()) map.up = document["up"].unit_vector().cast<float>();
    const Field planes = document["planes"], lines = document["lines"], points = document["points"];
    for (std::size_t i = 0; i < planes.size(); ++i) add_plane(planes.element(i), map);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Field line = lines.element(i);
        const auto ids = ids_of<2>(line["planes"], map);
        map.lines.push_back(
            {ids[0], ids[1], line["from"].position().cast<float>(), line["to"].position().cast<float>()});
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Field point = points.element(i);
        map.points.push_back({ids_of<3>(point["planes"], map), point["position"].position().cast<float>()});
    }
    return map;
}

}  // namespace

PlaneMap read_planes_json(const std::filesystem::path& file) {
    const json document = read_json_object(file, kLargest);
    try {
        const auto format = document.find("format");
        if (format == document.end() || *format != "planemap planes 1")
            throw std::invalid_argument("is no planes.json: its format is not \"planemap planes 1\"");
        return map_of(Field(document, ""));
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.string() + ": " + error.what());
    }
}

}  // namespace planemap::exports
