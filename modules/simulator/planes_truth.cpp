// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/planes_truth.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files.hpp"

namespace planemap::simulator {

namespace {

using Json = nlohmann::json;

constexpr double kLeastStay_s = 1;

Json to_json(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// Stamps of a time after the world's change, seconds as trajectory files have them.
class Clock {
  public:
    explicit Clock(const SimulatedSource& source)
        : start_s_(static_cast<double>(source.utime(0)) * 1e-6), change_s_(source.options().change_s) {}

    /// Adds "from" and "until", each where it is not always.
    void add(double from_s, double until_s, Json& object) const {
        const auto stamp = [&](double seconds) {
            return std::round((start_s_ + change_s_ + seconds) * 1e6) * 1e-6;
        };
        if (std::isfinite(from_s)) object["from"] = stamp(from_s);
        if (std::isfinite(until_s)) object["until"] = stamp(until_s);
    }

  private:
    double start_s_, change_s_;
};

const char* name_of(Material material) {
    switch (material) {
        case Material::kBlack:
            return "black";
        case Material::kMirror:
            return "mirror";
        case Material::kGlass:
            return "glass";
        default:
            return "matt";
    }
}

/// A surface and its rectangles, moved.
Json plane_of(const World& world, const TimedSurface& timed, std::size_t id) {
    const Surface& surface = world.surfaces[static_cast<std::size_t>(timed.surface)];
    const Pose& moved = timed.stay.world_from_rest;
    Json rectangles = Json::array();
    double area = 0;
    Material material = Material::kMatt;
    for (const Rectangle& rectangle : world.rectangles) {
        if (rectangle.surface != timed.surface || rectangle.picture) continue;
        Json corners = Json::array();
        for (const Eigen::Vector3d& corner : rectangle.corners())
            corners.push_back(to_json(timed.body < 0 ? corner : Eigen::Vector3d(moved * corner)));
        rectangles.push_back(corners);
        area += 4 * rectangle.half_u.norm() * rectangle.half_v.norm();
        material = rectangle.material;
    }
    const Plane plane = timed.body < 0 ? surface.plane : moved * surface.plane;
    Json json{{"id", id},     {"name", surface.name}, {"normal", to_json(plane.normal)},
              {"d", plane.d}, {"area", area},         {"rectangles", rectangles}};
    if (material != Material::kMatt) json["material"] = name_of(material);
    return json;
}

Json camera_of(const PinholeCamera& camera) {
    return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
            {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
}

/// What the bias makes of 1, 2 and 4 m, metres, at a few pixels.
Json bias_of(const DepthBias& bias, const PinholeCamera& camera) {
    constexpr int kColumns = 5, kRows = 4;
    Json columns = Json::array(), rows = Json::array(), json;
    const auto pixel = [](int i, int count, int size) { return (2 * i + 1) * size / (2 * count); };
    for (int i = 0; i < kColumns; ++i) columns.push_back(pixel(i, kColumns, camera.width));
    for (int i = 0; i < kRows; ++i) rows.push_back(pixel(i, kRows, camera.height));
    for (const int metres : {1, 2, 4}) {
        Json table = Json::array();
        for (const int v : rows) {
            Json row = Json::array();
            for (const int u : columns) row.push_back(bias.read(u, v, metres) - metres);
            table.push_back(row);
        }
        json["error_at_" + std::to_string(metres) + "m"] = table;
    }
    json["columns"] = columns;
    json["rows"] = rows;
    return json;
}

Json sensor_of(const SimulatedSource& source) {
    const SimulatorOptions& options = source.options();
    const TrueCameras& cameras = source.true_cameras();
    const Twist twist = twist_from_pose(cameras.color_from_depth);
    Json json{
        {"profile", options.profile},
        {"specimen", options.specimen},
        {"depth_camera", camera_of(cameras.depth)},
        {"color_camera", camera_of(cameras.color)},
        {"color_from_depth",
         {{"rotation_vector_rad", to_json(twist.tail<3>())}, {"translation_m", to_json(twist.head<3>())}}},
        {"distortion", options.lens.empty() ? options.distortion : 0.0}};
    if (!options.lens.empty()) json["lens"] = options.lens;
    if (source.bias()) json["bias"] = bias_of(*source.bias(), cameras.depth);
    return json;
}

bool has_errors(const SimulatorOptions& options) {
    return !options.profile.empty() || options.bias > 0 || options.focal_error > 0 ||
           options.mount_error_deg > 0 || options.distortion > 0 || !options.lens.empty();
}

}  // namespace

std::vector<TimedSurface> timed_surfaces(const World& world) {
    std::vector<int> body_of(world.surfaces.size(), -1);
    for (const Rectangle& rectangle : world.rectangles)
        body_of[static_cast<std::size_t>(rectangle.surface)] = rectangle.body;
    std::vector<TimedSurface> timed;
    for (std::size_t i = 0; i < world.surfaces.size(); ++i) {
        const int body = body_of[i];
        if (body < 0) {
            timed.push_back({static_cast<int>(i), -1, {}});
            continue;
        }
        for (const Body::Stay& stay : world.bodies[static_cast<std::size_t>(body)].stays(kLeastStay_s))
            timed.push_back({static_cast<int>(i), body, stay});
    }
    return timed;
}

void write_planes_truth(const std::filesystem::path& file, const SimulatedSource& source,
                        const std::string& log) {
    const World& world = source.world();
    const Clock clock(source);
    Json planes = Json::array(), bodies = Json::array();
    for (const TimedSurface& timed : timed_surfaces(world)) {
        Json plane = plane_of(world, timed, planes.size());
        if (timed.body >= 0) {
            plane["body"] = world.bodies[static_cast<std::size_t>(timed.body)].name;
            clock.add(timed.stay.from_s, timed.stay.until_s, plane);
        }
        planes.push_back(plane);
    }
    for (const Body& body : world.bodies) {
        Json json{{"name", body.name}};
        clock.add(body.from_s, body.until_s, json);
        bodies.push_back(json);
    }
    Json truth{{"world", world.name}, {"planes", planes}};
    if (!bodies.empty()) truth["bodies"] = bodies;
    if (has_errors(source.options())) truth["sensor"] = sensor_of(source);
    if (!log.empty()) truth["log"] = log;
    write_file(file, truth.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace planemap::simulator
