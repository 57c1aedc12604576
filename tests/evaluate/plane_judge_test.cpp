// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_judge.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

Judgement judged(const PlaneMap& map) {
    return judge(truth_of(room()), map, Pose::Identity());
}

Pose some_motion() {
    return make_pose({3, -2, 0.7}, Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2));
}

TEST(Judge, APerfectMapIsPerfect) {
    const Judgement judgement = judged(map_of(room()));
    EXPECT_EQ(judgement.seen(), 4u);  // the shelf is too small
    EXPECT_EQ(judgement.found(), 4u);
    EXPECT_EQ(judgement.split(), 0u);
    EXPECT_TRUE(judgement.spurious.empty());
    EXPECT_GT(judgement.outline_iou().value(), 0.999);
    ASSERT_EQ(judgement.distances.size(), 1u);
    EXPECT_NEAR(judgement.distances[0].truth, 4, 1e-6);
    EXPECT_LT(judgement.distances[0].error(), 1e-5);
    ASSERT_EQ(judgement.angles.size(), 5u);
    for (const PairMeasure& pair : judgement.angles) EXPECT_LT(pair.error(), 1e-3);
    EXPECT_TRUE(judgement.look_alikes.empty());
}

TEST(Judge, FiguresDoNotDependOnTheWorldOfTheMap) {
    std::vector<Face> faces = room();
    faces[1].centre.x() -= 0.02;
    faces[2].half_y = 0.8;
    const Judgement here = judged(map_of(faces));
    const Pose motion = some_motion();
    for (Face& face : faces) {
        face.centre = motion * face.centre;
        face.normal = motion.linear() * face.normal;
        face.x = motion.linear() * face.x;
    }
    const Judgement there = judge(truth_of(room()), map_of(faces), motion.inverse(Eigen::Isometry));
    EXPECT_EQ(there.found(), here.found());
    EXPECT_NEAR(there.outline_iou().value(), here.outline_iou().value(), 0.01);
    ASSERT_EQ(there.distances.size(), here.distances.size());
    EXPECT_NEAR(here.distances[0].map, 4.02, 1e-5);
    EXPECT_NEAR(there.distances[0].map, 4.02, 1e-5);
    for (std::size_t i = 0; i < here.angles.size(); ++i)
        EXPECT_NEAR(there.angles[i].map, here.angles[i].map, 1e-3);
}

TEST(Judge, MissesWhatIsMissing) {
    std::vector<Face> faces = room();
    faces.erase(faces.begin() + 1);
    const Judgement judgement = judged(map_of(faces));
    EXPECT_EQ(judgement.seen(), 4u);
    EXPECT_EQ(judgement.found(), 3u);
    EXPECT_EQ(judgement.planes[1].best, -1);
    EXPECT_TRUE(judgement.distances.empty());
    EXPECT_GT(judgement.outline_iou().value(), 0.999);  // of those that are found
}

TEST(Judge, AnEmptyMapHasNothing) {
    const Judgement judgement = judged({});
    EXPECT_EQ(judgement.seen(), 4u);
    EXPECT_EQ(judgement.found(), 0u);
    EXPECT_FALSE(judgement.outline_iou());
    EXPECT_TRUE(judgement.angles.empty());
}

TEST(Judge, WithoutTruthEverythingIsSpurious) {
    const Judgement judgement = judge({}, map_of(room()), Pose::Identity());
    EXPECT_EQ(judgement.seen(), 0u);
    EXPECT_EQ(judgement.spurious.size(), 4u);  // the shelf is too small
    EXPECT_FALSE(judgement.outline_iou());
}

TEST(Judge, CountsADoubledPlane) {
    PlaneMap map = map_of(room());
    Face again = room()[0];
    again.centre.z() = 0.03;
    map.planes.push_back(map_plane(30, again));
    const Judgement judgement = judged(map);
    EXPECT_EQ(judgement.split(), 1u);
    EXPECT_EQ(judgement.planes[0].parts, (std::vector<int>{10, 30}));
    EXPECT_EQ(judgement.found(), 4u);
    EXPECT_TRUE(judgement.spurious.empty());
}

TEST(Judge, CountsAPlaneInPieces) {
    std::vector<Face> faces = room();
    Face half = faces[0];
    half.half_x = 1.2;
    half.centre.x() = -0.8;
    faces[0] = half;
    half.half_x = 0.75;
    half.centre.x() = 1.2;
    faces.push_back(half);
    const Judgement judgement = judged(map_of(faces));
    EXPECT_EQ(judgement.split(), 1u);
    EXPECT_EQ(judgement.planes[0].best, 10);
    EXPECT_NEAR(judgement.planes[0].covered, 0.6, 0.02);
    EXPECT_GT(judgement.planes[0].iou, 0.95);  // the pieces together
}

TEST(Judge, DoesNotFindAPlaneThatIsDisplaced) {
    std::vector<Face> faces = room();
    faces[1].centre.x() -= 0.06;
    const Judgement judgement = judged(map_of(faces));
    EXPECT_EQ(judgement.found(), 3u);
    ASSERT_EQ(judgement.spurious.size(), 1u);
    EXPECT_EQ(judgement.spurious[0].id, 11);
    EXPECT_EQ(judgement.spurious[0].on_true_plane, 0);
}

TEST(Judge, DoesNotFindAPlaneFromItsBack) {
    std::vector<Face> faces = room();
    faces[1].normal *= -1;
    EXPECT_EQ(judged(map_of(faces)).found(), 3u);
}

TEST(Judge, MeasuresWhatIsAskew) {
    std::vector<Face> faces = room();
    const Eigen::AngleAxisd turn(radians(2), Eigen::Vector3d::UnitZ());
    faces[1].normal = turn * faces[1].normal;
    faces[1].x = turn * faces[1].x;
    faces[2].centre.x() += 0.03;
    const Judgement judgement = judged(map_of(faces));
    EXPECT_NEAR(judgement.planes[1].angle_deg, 2, 1e-3);
    EXPECT_NEAR(judgement.planes[2].distance_m, -0.03, 1e-4);  // behind the true plane
    EXPECT_NEAR(judgement.distances[0].error(), 0.03, 0.002);
    double worst = 0;
    for (const PairMeasure& pair : judgement.angles) worst = std::max(worst, pair.error());
    EXPECT_NEAR(worst, 2, 1e-3);
}

TEST(Judge, ReportsASpuriousPlane) {
    PlaneMap map = map_of(room());
    map.planes.push_back(map_plane(40, {"", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1, 0.5}));
    map.planes.push_back(map_plane(41, {"", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0.3, 0.3}));  // too small
    const Judgement judgement = judged(map);
    ASSERT_EQ(judgement.spurious.size(), 1u);
    EXPECT_EQ(judgement.spurious[0].id, 40);
    EXPECT_NEAR(judgement.spurious[0].area, 2, 0.01);
    EXPECT_EQ(judgement.found(), 4u);
}

TEST(Judge, AnOutlineThatIsTooLargeCosts) {
    std::vector<Face> faces = room();
    faces[0].half_x *= 1.5;
    const Judgement judgement = judged(map_of(faces));
    EXPECT_NEAR(judgement.planes[0].iou, 1 / 1.5, 0.01);
    EXPECT_LT(judgement.outline_iou().value(), 0.9);
}

TEST(Judge, AMapPlaneMayBeOnTwoPartsOfOnePlane) {
    const Face both{"", {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 2, 1};
    const TruePlane whole = true_plane(both);
    std::vector<TruePlane> truth{whole, whole};
    for_each_cell(whole.visible, [&](int x, int y) {
        for (const int side : {0, 1})
            if ((x < 0) != (side == 0))
                truth[static_cast<std::size_t>(side)].visible.mask.cells[whole.visible.mask.index(
                    x - whole.visible.x0, y - whole.visible.y0)] = 0;
    });
    const Judgement judgement = judge(truth, map_of({both}), Pose::Identity());
    for (const TruePlaneVerdict& plane : judgement.planes) {
        EXPECT_NEAR(plane.area, 4, 1e-9);
        EXPECT_TRUE(plane.found);
        EXPECT_GT(plane.iou, 0.999);
    }
    EXPECT_EQ(judgement.split(), 0u);
    EXPECT_TRUE(judgement.spurious.empty());
}

TEST(Judge, NamesPlanesThatTheMapperMayMerge) {
    std::vector<Face> faces = room();
    faces.push_back({"doormat", {0, 0, 0.03}, {0, 0, 1}, {1, 0, 0}, 0.6, 0.6});
    const Judgement judgement = judge(truth_of(faces), map_of(faces), Pose::Identity());
    ASSERT_EQ(judgement.look_alikes.size(), 1u);
    EXPECT_EQ(judgement.look_alikes[0].a, 0u);
    EXPECT_EQ(judgement.look_alikes[0].b, 5u);
    EXPECT_NEAR(judgement.look_alikes[0].distance_m, 0.03, 1e-9);
}

TEST(Judge, NamesTheTruePlanesThatShareAMapPlane) {
    std::vector<Face> faces = room();
    const PlaneMap map = map_of(faces);
    faces.push_back({"doormat", {0, 0, 0.03}, {0, 0, 1}, {1, 0, 0}, 0.2, 0.2});
    faces.push_back({"coaster", {1, 0, 0.03}, {0, 0, 1}, {1, 0, 0}, 0.05, 0.05});
    const Judgement judgement = judge(truth_of(faces), map, Pose::Identity());
    ASSERT_EQ(judgement.shared.size(), 1u);
    EXPECT_EQ(judgement.shared[0].id, 10);
    ASSERT_EQ(judgement.shared[0].shares.size(), 2u);
    EXPECT_EQ(judgement.shared[0].shares[0].plane, 0u);
    EXPECT_EQ(judgement.shared[0].shares[1].plane, 5u);
    EXPECT_NEAR(judgement.shared[0].shares[1].area, 0.16, 0.01);
}

}  // namespace
}  // namespace planemap::evaluation
