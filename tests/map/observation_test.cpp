// SPDX-License-Identifier: BSD-3-Clause
#include "map/observation.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::stored_at;
using samples::wall_at;

StoredRegion seen_at(double depth) {
    return stored_at(Pose::Identity(), {wall_at(0, 0, depth)}).regions[0];
}

TEST(ObservationModel, AFartherRegionCountsLess) {
    const ObservationModel model = observation_model({});
    const DepthNoise noise;
    double weight = 1.1, sigma = 0;
    int strength = 3;
    for (const double depth : {0.6, 1.0, 2.0, 3.0, 5.0, 8.0}) {
        const StoredRegion region = seen_at(depth);
        EXPECT_LT(model.weight(region, noise), weight);
        EXPECT_GT(model.weight(region, noise), 0);
        EXPECT_GT(model.reliability(region, noise).sigma_m, sigma);
        EXPECT_LE(model.strength(region, noise), strength);
        weight = model.weight(region, noise);
        sigma = model.reliability(region, noise).sigma_m;
        strength = model.strength(region, noise);
        EXPECT_EQ(model.reliability(region, noise).weight, weight);
    }
    EXPECT_EQ(model.strength(seen_at(0.6), noise), 2);
    EXPECT_EQ(strength, 0);
}

TEST(ObservationModel, WithoutNoiseAllCountAlike) {
    const ObservationModel model = observation_model({});
    const DepthNoise none{0, 0, 0};
    for (const double depth : {0.5, 8.0}) {
        EXPECT_EQ(model.weight(seen_at(depth), none), 1);
        EXPECT_EQ(model.reliability(seen_at(depth), none).sigma_m, model.agreement_m);
        EXPECT_EQ(model.strength(seen_at(depth), none), 2);
    }
}

TEST(Observation, LiesWhereItsKeyframeStands) {
    const Pose world_from_camera = scene::camera_at({5, -2, 1}, 0.7);
    const StoredKeyframe keyframe =
        stored_at(world_from_camera, {{scene::facing({5, 0, 3}, {0, -1, -1}, {1, 0, 0}), 0.5, 0.4, {}}});
    const Observation seen(keyframe, keyframe.regions[0]);
    EXPECT_LT((seen.world_from_box().translation() - Eigen::Vector3d(5, 0, 3)).norm(), 1e-5);
    EXPECT_TRUE(seen.is_near());
    StoredKeyframe afar = keyframe;
    afar.world_from_camera->pretranslate(Eigen::Vector3d(2 * kMaxCoordinate_m, 0, 0));
    EXPECT_FALSE(Observation(afar, afar.regions[0]).is_near());
}

}  // namespace
}  // namespace planemap::map
