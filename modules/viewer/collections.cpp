// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/collections.hpp"

#include "core/id_color.hpp"

namespace planemap::viewer {

namespace {

vs::object_t object_of(std::int64_t id, const Pose& local_from_object) {
    const Eigen::Quaterniond q(local_from_object.rotation());
    const Eigen::Vector3d p = local_from_object.translation();
    vs::object_t object;
    object.id = id;
    object.x = p.x(), object.y = p.y(), object.z = p.z();
    object.qw = q.w(), object.qx = q.x(), object.qy = q.y(), object.qz = q.z();
    return object;
}

vs::object_collection_t collection_of(Collection id, const char* name, std::int16_t type,
                                      std::vector<vs::object_t> objects) {
    vs::object_collection_t collection;
    collection.id = id;
    collection.name = name;
    collection.type = type;
    collection.reset = 1;
    collection.nobjects = static_cast<std::int32_t>(objects.size());
    collection.objects = std::move(objects);
    return collection;
}

vs::point3d_list_t ring_list(std::int64_t id, const Ring& ring, const Pose& local_from_plane,
                             const Rgb& color) {
    vs::point3d_list_t list;
    list.id = id;
    list.collection = kLocalFrame;
    list.element_id = 0;
    vs::color_t shade;
    shade.r = static_cast<float>(color.r) / 255, shade.g = static_cast<float>(color.g) / 255,
    shade.b = static_cast<float>(color.b) / 255;
    for (const Eigen::Vector2d& vertex : ring) {
        const Eigen::Vector3d p = local_from_plane * Eigen::Vector3d(vertex.x(), vertex.y(), 0);
        vs::point3d_t point;
        point.x = p.x(), point.y = p.y(), point.z = p.z();
        list.points.push_back(point);
    }
    list.colors.assign(list.points.size(), shade);
    list.npoints = list.ncolors = static_cast<std::int32_t>(list.points.size());
    list.nnormals = list.npointids = 0;
    return list;
}

}  // namespace

vs::object_collection_t local_frame_collection() {
    return collection_of(kLocalFrame, "planemap local frame", vs::object_collection_t::AXIS3D,
                         {object_of(0, Pose::Identity())});
}

vs::object_collection_t keyframe_collection(const KeyframeTrajectory& trajectory,
                                            const Pose& local_from_world, const Pose& body_from_camera) {
    const Pose camera_from_body = body_from_camera.inverse();
    std::vector<vs::object_t> objects;
    for (const KeyframePose& keyframe : trajectory.keyframes)
        objects.push_back(
            object_of(keyframe.id, local_from_world * keyframe.world_from_camera * camera_from_body));
    return collection_of(kKeyframes, "planemap keyframes", vs::object_collection_t::POSE3D,
                         std::move(objects));
}

vs::point3d_list_collection_t plane_collection(const PlaneMap& map, const Pose& local_from_world) {
    vs::point3d_list_collection_t collection;
    collection.id = kPlanes;
    collection.name = "planemap planes";
    collection.type = vs::point3d_list_collection_t::LINE_LOOP;
    collection.reset = 1;
    for (const MapPlane& plane : map.planes) {
        const Pose local_from_plane = local_from_world * plane.world_from_plane();
        for (const Ring& ring : plane.outline.rings().rings) {
            const auto id = static_cast<std::int64_t>(collection.point_lists.size());
            collection.point_lists.push_back(ring_list(id, ring, local_from_plane, id_color(plane.id)));
        }
    }
    collection.nlists = static_cast<std::int32_t>(collection.point_lists.size());
    return collection;
}

}  // namespace planemap::viewer
