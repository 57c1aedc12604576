// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_set.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::estimate_of;
using samples::kRules;
using samples::wall_at;
using scene::facing;
using scene::Rectangle;

TEST(PlaneSet, AfterMergingNoPairSatisfiesTheRules) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> at(-3, 3), tilt(-0.2, 0.2), size(0.1, 0.6);
    PlaneSet set(kRules, 200);
    std::vector<std::size_t> all;
    double points = 0;
    for (int i = 0; i < 60; ++i) {
        const Rectangle r{facing({at(random), at(random), 3 + 0.03 * at(random)},
                                 {tilt(random), tilt(random), -1}, {1, 0, 0}),
                          size(random),
                          size(random),
                          {}};
        all.push_back(set.push_back(estimate_of(r, i)));
        points += set.estimates().back().moments.count;
    }
    const std::vector<std::size_t> now = set.merge(all);
    const auto& estimates = set.estimates();
    EXPECT_LT(estimates.size(), 60u);
    EXPECT_GT(estimates.size(), 1u);
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        points -= estimates[i].moments.count;
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(same_plane(estimates[i].plane, estimates[i].box, estimates[j].plane,
                                    estimates[j].box, kRules));
        }
    }
    EXPECT_NEAR(points, 0, 1e-6) << "nothing is lost";
    std::vector<int> oldest(estimates.size(), 1000);
    for (std::size_t i = 0; i < now.size(); ++i)
        oldest[now[i]] = std::min(oldest[now[i]], static_cast<int>(i));
    for (std::size_t i = 0; i < estimates.size(); ++i) EXPECT_EQ(estimates[i].id, oldest[i]);
}

TEST(PlaneSet, DoesNotGrowBeyondTheLargestExtent) {
    PlaneSet set(kRules, 5);
    set.push_back(estimate_of(wall_at(0, 0, 3), 0));
    for (int i = 1; i < 10; ++i) set.push_back(estimate_of(wall_at(i, 0, 3), i));
    set.merge({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    EXPECT_GT(set.estimates().size(), 1u);
    for (const PlaneEstimate& estimate : set.estimates()) EXPECT_LT(estimate.box.half_extents.x(), 2.6);
}

TEST(PlaneSet, APartnerIsTheBestFitOrNone) {
    PlaneSet set(kRules, 200);
    const StoredKeyframe keyframe = samples::stored_at(Pose::Identity(), {wall_at(0, 0, 3)});
    const PlacedRegion region(Pose::Identity(), keyframe.regions[0]);
    EXPECT_EQ(set.partner_of(region), PlaneSet::none());
    set.push_back(estimate_of(wall_at(0, 0, 3.04), 0));
    set.push_back(estimate_of(wall_at(0.2, 0, 3.01), 1));
    set.push_back(estimate_of(wall_at(0, 0, 4), 2));
    EXPECT_EQ(set.partner_of(region), 1u);
    set.clear();
    EXPECT_EQ(set.partner_of(region), PlaneSet::none());
    EXPECT_TRUE(set.merge({}).empty());
}

}  // namespace
}  // namespace planemap::map
