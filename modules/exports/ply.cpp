// SPDX-License-Identifier: BSD-3-Clause
#include "exports/exports.hpp"
#include "exports/little_endian.hpp"
#include "exports/parts.hpp"

namespace planemap::exports {

namespace {

/// The parts of a PLY file, in the order of its elements.
class Ply {
  public:
    int vertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, const Rgb& color) {
        for (const Eigen::Vector3d& v : {position, normal})
            for (const double value : {v.x(), v.y(), v.z()}) put(vertices_, static_cast<float>(value));
        for (const std::uint8_t value : {color.r, color.g, color.b}) put(vertices_, value);
        return vertex_count_++;
    }
    void face(int a, int b, int c) {
        put(faces_, std::uint8_t{3});
        for (const std::int32_t i : {a, b, c}) put(faces_, i);
        ++face_count_;
    }
    void edge(int a, int b) {
        for (const std::int32_t i : {a, b}) put(edges_, i);
        ++edge_count_;
    }
    void comment(const std::string& text) { comments_ += "comment " + text + "\n"; }

    std::string bytes() const {
        std::string text = "ply\nformat binary_little_endian 1.0\n" + comments_ + "element vertex " +
                           std::to_string(vertex_count_) +
                           "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
                           "property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
                           "property uchar blue\nelement face " +
                           std::to_string(face_count_) + "\nproperty list uchar int vertex_indices\n";
        if (edge_count_ > 0) {
            text += "element edge " + std::to_string(edge_count_) +
                    "\nproperty int vertex1\nproperty int vertex2\n";
        }
        return text + "end_header\n" + vertices_ + faces_ + edges_;
    }

  private:
    std::string vertices_, faces_, edges_, comments_;
    int vertex_count_ = 0, face_count_ = 0, edge_count_ = 0;
};

}  // namespace

std::string planes_ply(const PlaneMap& map, const Trajectory& trajectory) {
    const UprightFrame frame = upright_frame(map, trajectory);
    const Eigen::Matrix3d& level = frame.level_from_world;
    Ply ply;
    ply.comment("planemap: planes of a map");
    for (const std::string& note : frame.notes(level, 'z')) ply.comment(note);
    for (const MapPlane* plane : drawable_planes(map)) {
        const PlaneMesh mesh = mesh_of(*plane);
        const Eigen::Vector3d normal = level * plane->normal.cast<double>().normalized();
        int first = 0;
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const int index =
                ply.vertex(level * mesh.vertices[i].cast<double>(), normal, id_color(plane->id));
            if (i == 0) first = index;
        }
        for (const auto& [a, b, c] : mesh.triangles) ply.face(first + a, first + b, first + c);
        ply.comment("plane " + std::to_string(plane->id) + " " + label_name(plane->label) + ", " +
                    std::to_string(mesh.triangles.size()) + " faces");
    }
    int last = -1;
    for (const Eigen::Vector3d& p : walked(trajectory)) {
        const int index = ply.vertex(level * p, Eigen::Vector3d::UnitZ(), kTrajectoryColor);
        if (last >= 0) {
            ply.edge(last, index);
        } else {
            ply.comment("trajectory: the vertices from " + std::to_string(index) + " on, joined by edges");
        }
        last = index;
    }
    return ply.bytes();
}

std::string points_ply(const std::vector<CloudPoint>& points, const std::string& comment) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
                        std::to_string(points.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                        "property uchar green\nproperty uchar blue\nproperty int plane\nend_header\n";
    for (const CloudPoint& point : points) {
        for (const float value : {point.position.x(), point.position.y(), point.position.z()})
            put(bytes, value);
        for (const std::uint8_t value : {point.color.r, point.color.g, point.color.b}) put(bytes, value);
        put(bytes, std::int32_t{point.plane});
    }
    return bytes;
}

}  // namespace planemap::exports
