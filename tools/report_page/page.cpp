// SPDX-License-Identifier: BSD-3-Clause
#include "report_page/page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>

#include "core/files.hpp"

namespace planemap {

extern const std::string_view kPageTemplate;  // page/report.html, see CMakeLists.txt

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMarker = "@PLANEMAP_DATA@";
constexpr std::size_t kMostPoints = 80'000, kMostPoses = 5'000;
constexpr std::size_t kMostPlanesBytes = std::size_t{64} << 20;

std::string base64(std::string_view bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63U];
    }
    return text;
}

/// Little-endian, as JavaScript's typed arrays read it.
template <typename T>
std::string base64_of(const std::vector<T>& values) {
    static_assert(std::endian::native == std::endian::little);
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return base64(bytes);
}

/// Indices of at most `most` of `count` things, evenly spread.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
    std::vector<std::size_t> indices(std::min(count, most));
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i * count / indices.size();
    return indices;
}

/// Without what the page does not show, and is much.
Json shown_planes(Json planes) {
    if (!planes.is_object() || !planes.contains("planes") || !planes["planes"].is_array()) return nullptr;
    for (Json& plane : planes["planes"])
        if (plane.is_object())
            for (const char* key : {"keyframes", "box_corners"}) plane.erase(key);
    return planes;
}

/// Where each plane stands in planes.json, by its id.
std::map<int, std::int16_t> places_of(const Json& planes) {
    std::map<int, std::int16_t> places;
    if (planes.is_null()) return places;
    const Json& list = planes["planes"];
    for (std::size_t i = 0; i < std::min<std::size_t>(list.size(), 32767); ++i)
        if (list[i].is_object() && list[i].contains("id") && list[i]["id"].is_number_integer())
            places.emplace(list[i]["id"].get<int>(), static_cast<std::int16_t>(i));
    return places;
}

Json shown_points(const std::vector<CloudPoint>& points, const Json& planes) {
    const std::map<int, std::int16_t> places = places_of(planes);
    const std::vector<std::size_t> chosen = spread(points.size(), kMostPoints);
    Eigen::AlignedBox3f box;
    for (const std::size_t i : chosen) box.extend(points[i].position);
    Json origin = Json::array(), step = Json::array();
    Eigen::Vector3f per_step = Eigen::Vector3f::Ones();
    for (int k = 0; k < 3 && !chosen.empty(); ++k) {
        const float size = box.sizes()[k];
        if (size > 0) per_step[k] = size / 65535;
        origin.push_back(box.min()[k]);
        step.push_back(per_step[k]);
    }
    std::vector<std::uint16_t> positions;
    std::vector<std::uint8_t> colors;
    std::vector<std::int16_t> on;
    for (const std::size_t i : chosen) {
        const CloudPoint& point = points[i];
        for (int k = 0; k < 3; ++k)
            positions.push_back(static_cast<std::uint16_t>(
                std::clamp(std::round((point.position[k] - box.min()[k]) / per_step[k]), 0.0F, 65535.0F)));
        for (const std::uint8_t value : {point.color.r, point.color.g, point.color.b})
            colors.push_back(value);
        const auto place = places.find(point.plane);
        constexpr std::int16_t kNone = -1, kUnknown = -2;
        on.push_back(point.plane < 0 ? kNone : place == places.end() ? kUnknown : place->second);
    }
    return {{"total", points.size()},
            {"shown", chosen.size()},
            {"origin", origin},
            {"step", step},
            {"positions", base64_of(positions)},
            {"colors", base64_of(colors)},
            {"planes", base64_of(on)}};
}

Json shown_trajectory(const Trajectory& trajectory) {
    std::vector<float> positions;
    for (const std::size_t i : spread(trajectory.size(), kMostPoses)) {
        const Eigen::Vector3f p = trajectory[i].world_from_camera.translation().cast<float>();
        if (p.allFinite()) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
    }
    if (positions.empty()) return nullptr;
    return {{"positions", base64_of(positions)}};
}

/// Against gravity in the world: the map's, or, while it does not know, as the camera was held on average.
void add_up(const Json& planes, const Trajectory& trajectory, Json& data) {
    const Json up = planes.is_object() ? planes.value("up", Json()) : Json();
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    if (up.is_array() && up.size() == 3 &&
        std::all_of(up.begin(), up.end(), [](const Json& v) { return v.is_number(); }))
        direction = {up[0].get<double>(), up[1].get<double>(), up[2].get<double>()};
    data["up_known"] = direction.allFinite() && direction.norm() > 0.5;
    if (!data["up_known"].get<bool>()) {
        direction.setZero();
        for (const StampedPose& pose : trajectory) direction -= pose.world_from_camera.linear().col(1);
        if (!direction.allFinite() || direction.norm() < 1e-6) direction = {0, -1, 0};
        direction.normalize();
    }
    data["up"] = {direction.x(), direction.y(), direction.z()};
}

/// JSON as text inside of HTML: no tag, comment or end of a script can begin in it.
std::string embedded(const Json& data) {
    const std::string plain = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string text;
    text.reserve(plain.size() + 64);
    for (const char c : plain) {
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    }
    return text;
}

/// Runs `read` if there is such a file; what goes wrong is a note.
void attempt(const std::filesystem::path& file, std::vector<std::string>& notes,
             const std::function<void()>& read) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return;
    try {
        read();
    } catch (const std::exception& error) {
        notes.emplace_back(error.what());
    }
}

}  // namespace

void PageSource::read_planes(const std::filesystem::path& file) {
    attempt(file, notes, [&] {
        Json read = Json::parse(read_file(file, kMostPlanesBytes), nullptr, false);
        if (shown_planes(read).is_null()) throw std::runtime_error(file.string() + ": is no planes.json");
        planes = std::move(read);
    });
}

void PageSource::read_trajectory(const std::filesystem::path& file) {
    attempt(file, notes, [&] { trajectory = planemap::read_trajectory(file); });
}

void PageSource::read_points(const std::filesystem::path& file) {
    attempt(file, notes, [&] { points = planemap::read_points(file); });
}

PageSource page_source_of(const std::filesystem::path& folder, Json report) {
    PageSource source;
    source.report = std::move(report);
    source.read_planes(folder / "planes.json");
    source.read_trajectory(folder / "trajectory.txt");
    source.read_points(folder / "points.ply");
    return source;
}

std::string report_page(const PageSource& source) {
    Json data;
    data["format"] = "planemap page 1";
    data["report"] = source.report;
    const Json planes = shown_planes(source.planes);
    add_up(planes, source.trajectory, data);
    data["trajectory"] = shown_trajectory(source.trajectory);
    data["points"] = source.points ? shown_points(*source.points, planes) : Json();
    data["planes"] = planes;
    data["notes"] = source.notes;
    const std::size_t at = kPageTemplate.find(kMarker);
    if (at == std::string_view::npos) throw std::logic_error("the page has no place for its data");
    return std::string(kPageTemplate.substr(0, at)) + embedded(data) +
           std::string(kPageTemplate.substr(at + kMarker.size()));
}

}  // namespace planemap
