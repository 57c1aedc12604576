// SPDX-License-Identifier: BSD-3-Clause
#include "segment/region_json.hpp"

#include <nlohmann/json.hpp>

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// A list of the columns of a symmetric or column-wise meant matrix.
Json columns_json(const Eigen::Matrix3d& m) {
    return {vector_json(m.col(0)), vector_json(m.col(1)), vector_json(m.col(2))};
}

Json outline_json(const PlanarRegion& region) {
    Json rings = Json::array();
    for (const Ring& ring : region.outline.rings) {
        Json points = Json::array();
        for (const Eigen::Vector2d& vertex : ring)
            points.push_back(
                vector_json(region.box.frame_from_box * Eigen::Vector3d(vertex.x(), vertex.y(), 0)));
        rings.push_back({{"hole", signed_area(ring) < 0}, {"points", std::move(points)}});
    }
    return rings;
}

}  // namespace

Json regions_json(const segmentation::Segmentation& segmentation) {
    std::vector<std::size_t> pixels(segmentation.regions.size() + 1);
    for (const std::uint16_t label : segmentation.labels.pixels) ++pixels.at(label);
    Json regions = Json::array();
    for (std::size_t i = 0; i < segmentation.regions.size(); ++i) {
        const PlanarRegion& region = segmentation.regions[i];
        const Pose& camera_from_box = region.box.frame_from_box;
        regions.push_back({{"label", i + 1},
                           {"normal", vector_json(region.plane.normal)},
                           {"d", region.plane.d},
                           {"pixels", pixels[i + 1]},
                           {"rms_m", region.rms},
                           {"box",
                            {{"centre", vector_json(camera_from_box.translation())},
                             {"axes", columns_json(camera_from_box.linear())},
                             {"half_extents", vector_json(region.box.half_extents)}}},
                           {"moments",
                            {{"count", region.moments.count},
                             {"sum", vector_json(region.moments.sum)},
                             {"scatter", columns_json(region.moments.scatter)}}},
                           {"outline", outline_json(region)}});
    }
    return regions;
}

}  // namespace planemap
