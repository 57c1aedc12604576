// SPDX-License-Identifier: BSD-3-Clause
#include "map/export.hpp"
#include "map/export_parts.hpp"

namespace planemap {

namespace {

std::string line(const char* keyword, const Eigen::Vector3d& v, int decimals) {
    return std::string(keyword) + " " + fixed(v.x(), decimals) + " " + fixed(v.y(), decimals) + " " +
           fixed(v.z(), decimals) + "\n";
}

}  // namespace

std::string planes_obj(const PlaneMap& map, const std::string& mtl_file) {
    std::string text = "# planemap: planes of a map, metres, world frame\nmtllib " + mtl_file + "\n";
    int vertices = 1, normals = 1;  // counted from 1 through the whole file
    for (const MapPlane* plane : drawable_planes(map)) {
        const PlaneMesh mesh = mesh_of(*plane);
        text += std::string("o ") + plane_name(*plane) + "\nusemtl plane_" + std::to_string(plane->id) + "\n";
        for (const Eigen::Vector3f& v : mesh.vertices) text += line("v", v.cast<double>(), 5);
        text += line("vn", plane->plane().normal, 6);
        const std::string normal = std::string("//") + std::to_string(normals);
        for (const auto& triangle : mesh.triangles) {
            const auto corner = [&](int i) { return std::to_string(vertices + i) + normal; };
            text += std::string("f ") + corner(triangle[0]) + " " + corner(triangle[1]) + " " +
                    corner(triangle[2]) + "\n";
        }
        vertices += static_cast<int>(mesh.vertices.size());
        normals += 1;
    }
    return text;
}

std::string planes_mtl(const PlaneMap& map) {
    std::string text = "# planemap: a colour a plane\n";
    for (const MapPlane* plane : drawable_planes(map)) {
        const Rgb color = plane_color(plane->id);
        text += "newmtl plane_" + std::to_string(plane->id) + "\n";
        text += line("Kd", Eigen::Vector3d(color.r, color.g, color.b) / 255, 4) + "Ks 0 0 0\n";
    }
    return text;
}

}  // namespace planemap
