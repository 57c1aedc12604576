// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/point_sample.hpp"

#include <gtest/gtest.h>

#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

/// Of 40 x 30 readings: the left half at 1 m, the rest at 2 m.
DepthView view() {
    CameraInfo info;
    info.depth = info.color = {40, 30, 40, 40, 19.5, 14.5};
    DepthImage depth(40, 30, 1000);
    for (int v = 0; v < 30; ++v)
        for (int u = 20; u < 40; ++u) depth(u, v) = 2000;
    return DepthView(depth, info, 0, 160);
}

/// The left half's wall has id 10.
std::vector<CloudPoint> sampled(const std::vector<PosedView>& views, std::int64_t most) {
    const PlaneMap map =
        map_of({{"wall", {0, 0, 1}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), 2, 2}});
    PointSample sample(views, most);
    soundness(map, views, {}, [&](const JudgedReading& reading) { sample.add(reading); });
    return sample.points();
}

std::vector<PosedView> in_a_row(const DepthView& view, int count) {
    std::vector<PosedView> views;
    for (int i = 0; i < count; ++i) {
        Pose pose = Pose::Identity();
        pose.translation().y() = 0.001 * i;
        views.push_back({&view, pose});
    }
    return views;
}

TEST(PointSample, IsAllOfFewReadings) {
    const DepthView of = view();
    for (const std::int64_t most : {2400, 2401, 100000}) {
        const std::vector<CloudPoint> points = sampled(in_a_row(of, 2), most);
        ASSERT_EQ(points.size(), 2u * 40 * 30);
        EXPECT_NEAR(points[0].position.x(), -19.5f / 40, 1e-6f);
        EXPECT_EQ(points[0].plane, 10);
        EXPECT_EQ(points[39].plane, CloudPoint::kNoPlane);
        EXPECT_EQ(points[0].color, CloudPoint::kNoColor);
    }
}

TEST(PointSample, OfManyItIsAsManyAsMayBeEvenlySpread) {
    const DepthView of = view();
    const std::vector<PosedView> views = in_a_row(of, 10);
    for (const std::int64_t most : {1, 7, 999, 1000, 5000, 11999}) {
        const std::vector<CloudPoint> points = sampled(views, most);
        ASSERT_EQ(points.size(), static_cast<std::size_t>(most));
        const double share = static_cast<double>(most) / 10;
        std::vector<int> of_view(10);
        int explained = 0;
        for (const CloudPoint& point : points) {
            // Which view: by its height, which a column of pixels has in steps of 1 / 40 m or 1 / 20.
            const double pixels =
                (static_cast<double>(point.position.y())) * 40 / static_cast<double>(point.position.z());
            const double millimetres =
                (pixels - (std::floor(pixels) + 0.5)) / 40 * static_cast<double>(point.position.z()) * 1000;
            ++of_view[static_cast<std::size_t>(std::lround(millimetres))];
            explained += point.plane == 10;
        }
        for (const int count : of_view) EXPECT_NEAR(count, share, 1);
        if (most > 100) {
            EXPECT_NEAR(explained, 5 * share, 0.5 * share);
        }
    }
}

TEST(PointSample, OfNothingIsNothing) {
    const DepthView of = view();
    EXPECT_TRUE(sampled({}, 100).empty());
    EXPECT_TRUE(sampled(in_a_row(of, 1), 0).empty());
}

}  // namespace
}  // namespace planemap::evaluation
