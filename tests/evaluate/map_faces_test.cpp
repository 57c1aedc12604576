// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map_faces.hpp"

#include <gtest/gtest.h>

#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kZ = Eigen::Vector3d::UnitZ();

/// Squares of 2 m about the z axis.
std::vector<MapFace> squares(const std::vector<double>& heights) {
    std::vector<Face> faces;
    for (const double z : heights) faces.push_back({"square", {0, 0, z}, kZ, kX, 1, 1});
    return faces_of(map_of(faces));
}

TEST(MapFaces, TheNearestOnWhoseOutlineThePointIs) {
    const std::vector<MapFace> faces = squares({0, 1, 1.1});
    ASSERT_EQ(faces[1].id, 11);
    const auto nearest = nearest_face(faces, {0.5, -0.5, 1.04}, 0.2);
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->index, 1u);
    EXPECT_NEAR(nearest->distance_m, 0.04, 1e-6);
    EXPECT_NEAR(nearest_face(faces, {0.5, -0.5, 1.06}, 0.2)->distance_m, -0.04, 1e-6);
    EXPECT_FALSE(nearest_face(faces, {0.5, -0.5, 1.04}, 0.03)) << "out of reach";
    EXPECT_FALSE(nearest_face(faces, {1.01, 0, 1.04}, 0.2)) << "beside the outline";
    EXPECT_TRUE(nearest_face(faces, {0.999, 0.999, 1.04}, 0.2)) << "to its corner";
    EXPECT_FALSE(nearest_face({}, {0, 0, 0}, 1));
}

TEST(MapFaces, AHoleIsNotCovered) {
    PlanarRegion region;
    region.plane = {kZ, 0};
    region.box.half_extents = {1, 1, 0.01};
    region.outline = {
        {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}}};
    const MapFace face(MapPlane(1, region, 1));
    EXPECT_FALSE(face.covers({0.49, 0, 7}));
    EXPECT_TRUE(face.covers({0.51, 0, -7}));
}

TEST(MapFaces, APlaneWithoutOutlineCoversNothing) {
    const MapFace face{MapPlane()};
    EXPECT_FALSE(face.covers({0, 0, 0}));
}

}  // namespace
}  // namespace planemap::evaluation
