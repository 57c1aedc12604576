// SPDX-License-Identifier: BSD-3-Clause
#include "exports/exports.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

namespace {

std::string line(const char* keyword, const Eigen::Vector3d& v, int decimals) {
    return std::string(keyword) + " " + fixed(v.x(), decimals) + " " + fixed(v.y(), decimals) + " " +
           fixed(v.z(), decimals) + "\n";
}

std::string diffuse(const Rgb& color) {
    return line("Kd", Eigen::Vector3d(color.r, color.g, color.b) / 255, 4) + "Ks 0 0 0\n";
}

}  // namespace

std::string planes_obj(const PlaneMap& map, const Trajectory& trajectory, const std::string& mtl_file) {
    const UprightFrame frame = upright_frame(map, trajectory);
    const Eigen::Matrix3d y_up = frame.y_up_from_world();
    std::string text = "# planemap: planes of a map\n";
    for (const std::string& note : frame.notes(y_up, 'y')) text += "# " + note + "\n";
    text += "mtllib " + mtl_file + "\n";
    int vertices = 1, normals = 1;  // counted from 1 through the whole file
    for (const MapPlane* plane : drawable_planes(map)) {
        const PlaneMesh mesh = mesh_of(*plane);
        text += std::string("o ") + plane_name(*plane) + "\nusemtl plane_" + std::to_string(plane->id) + "\n";
        for (const Eigen::Vector3f& v : mesh.vertices) text += line("v", y_up * v.cast<double>(), 5);
        text += line("vn", y_up * plane->plane().normal, 6);
        const std::string normal = std::string("//") + std::to_string(normals);
        for (const auto& triangle : mesh.triangles) {
            const auto corner = [&](int i) { return std::to_string(vertices + i) + normal; };
            text += std::string("f ") + corner(triangle[0]) + " " + corner(triangle[1]) + " " +
                    corner(triangle[2]) + "\n";
        }
        vertices += static_cast<int>(mesh.vertices.size());
        normals += 1;
    }
    const std::vector<Eigen::Vector3d> way = walked(trajectory);
    if (way.size() < 2) return text;
    text += std::string("o trajectory\nusemtl trajectory\n");
    for (const Eigen::Vector3d& p : way) text += line("v", y_up * p, 5);
    for (std::size_t i = 1; i < way.size(); ++i, ++vertices)  // a piece a line: readers have short ones
        text += "l " + std::to_string(vertices) + " " + std::to_string(vertices + 1) + "\n";
    return text;
}

std::string planes_mtl(const PlaneMap& map) {
    std::string text = "# planemap: a colour a plane\n";
    for (const MapPlane* plane : drawable_planes(map)) {
        const Rgb color = id_color(plane->id);
        text += "newmtl plane_" + std::to_string(plane->id) + "\n";
        text += diffuse(color);
    }
    return text + "newmtl trajectory\n" + diffuse(kTrajectoryColor);
}

}  // namespace planemap::exports
