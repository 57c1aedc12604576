// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/geometry/angle.hpp"

namespace planemap {
namespace {

using testing::ElementsAre;

constexpr double kDegree = radians(1);

StampedPose at(double seconds, double x, double y, double z) {
    return {std::llround(seconds * 1e6), make_pose({x, y, z}, Eigen::Quaterniond::Identity())};
}

/// A hand-like walk: 30 Hz, steps of some millimetres and tenths of a degree.
Trajectory walk(std::size_t poses, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Trajectory trajectory;
    Pose pose = Pose::Identity();
    Twist velocity = Twist::Zero();
    for (std::size_t i = 0; i < poses; ++i) {
        trajectory.push_back({static_cast<std::int64_t>(i) * 33333, pose});
        for (Eigen::Index axis = 0; axis < 6; ++axis) {
            velocity(axis) = 0.95 * velocity(axis) + 0.003 * normal(random);
        }
        pose = orthonormalised(pose * pose_from_twist(velocity));
    }
    return trajectory;
}

Trajectory moved(Trajectory trajectory, const Pose& other_world_from_world) {
    for (StampedPose& pose : trajectory) {
        pose.world_from_camera = other_world_from_world * pose.world_from_camera;
    }
    return trajectory;
}

Pose some_motion() {
    return make_pose({3, -2, 1}, Eigen::Quaterniond(0.3, -0.5, 0.7, 0.4));
}

void expect_all_near(const Statistics& s, double value, double tolerance) {
    EXPECT_NEAR(s.rmse, value, tolerance);
    EXPECT_NEAR(s.mean, value, tolerance);
    EXPECT_NEAR(s.median, value, tolerance);
    EXPECT_NEAR(s.min, value, tolerance);
    EXPECT_NEAR(s.max, value, tolerance);
    EXPECT_NEAR(s.std, 0.0, tolerance);
}

TEST(Statistics, HandChecked) {
    // 1, 2, 3, 4: squares 30 / 4 = 7.5, mean 2.5, variance 7.5 - 6.25 = 1.25.
    const Statistics s = statistics({4, 1, 3, 2});
    EXPECT_EQ(s.count, 4u);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
    EXPECT_DOUBLE_EQ(s.mean, 2.5);
    EXPECT_DOUBLE_EQ(s.median, 2.5);
    EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
    EXPECT_DOUBLE_EQ(s.min, 1);
    EXPECT_DOUBLE_EQ(s.max, 4);
    EXPECT_DOUBLE_EQ(statistics({5, 1, 9}).median, 5);
    EXPECT_EQ(statistics({}).count, 0u);
}

TEST(Associate, TakesTheClosestPairsFirstAndEachPoseOnce) {
    const Trajectory truth{at(0.000, 0, 0, 0), at(0.010, 0, 0, 0), at(0.100, 0, 0, 0), at(0.200, 0, 0, 0)};
    // 0.008 is 2 ms from the second and 8 ms from the first; 0.004 is 4 ms from the first and 6 ms from the
    // second: greedy by difference gives (1, 0.008) and (0, 0.004). 0.120 is 20 ms from 0.100: not closer
    // than the limit.
    const Trajectory estimate{at(0.004, 0, 0, 0), at(0.008, 0, 0, 0), at(0.120, 0, 0, 0),
                              at(0.2199, 0, 0, 0)};
    EXPECT_THAT(associate(truth, estimate, {}), ElementsAre(PosePair(0, 0), PosePair(1, 1), PosePair(3, 3)));
}

TEST(Associate, GreedyMayLeaveAPoseOver) {
    // 0.010 takes 0.012 (2 ms); then 0.000 has nothing left within 20 ms, though 0.012 would have done for
    // it.
    const Trajectory truth{at(0.000, 0, 0, 0), at(0.010, 0, 0, 0)};
    const Trajectory estimate{at(0.012, 0, 0, 0), at(0.028, 0, 0, 0)};
    EXPECT_THAT(associate(truth, estimate, {}), ElementsAre(PosePair(1, 0)));
}

TEST(Associate, OffsetIsAddedToTheEstimate) {
    const Trajectory truth{at(10, 0, 0, 0), at(11, 0, 0, 0)};
    const Trajectory estimate{at(3, 0, 0, 0), at(4, 0, 0, 0)};
    EXPECT_TRUE(associate(truth, estimate, {}).empty());
    EXPECT_THAT(associate(truth, estimate, {.offset_s = 7}), ElementsAre(PosePair(0, 0), PosePair(1, 1)));
}

TEST(Evaluate, AteHandChecked) {
    // The corners of a unit square, twice round. The estimate's z alternates +a -a +a -a in the first round
    // (a = 1 cm) and +b -b +b -b in the second (b = 3 cm). Summed over a round, z, z x and z y are zero about
    // the centre, so no rotation or translation is better than none, and the errors are four times a and four
    // times b: rmse = sqrt((1 + 9) / 2) cm, mean = median = 2 cm, std = 1 cm. Scale: sum x.x = 8 * 0.5 over 4
    // + 4 (a^2 + b^2).
    const double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Trajectory truth, estimate;
    for (int i = 0; i < 8; ++i) {
        const double height = (i < 4 ? 0.01 : 0.03) * (i % 2 == 0 ? 1 : -1);
        truth.push_back(at(i, corner[i % 4][0], corner[i % 4][1], 0));
        estimate.push_back(at(i, corner[i % 4][0], corner[i % 4][1], height));
    }
    const Evaluation evaluation = evaluate(truth, moved(estimate, some_motion()), {});
    ASSERT_TRUE(evaluation.ate);
    const Statistics& ate = evaluation.ate->metres;
    EXPECT_EQ(ate.count, 8u);
    EXPECT_NEAR(ate.rmse, 0.01 * std::sqrt(5), 1e-12);
    EXPECT_NEAR(ate.mean, 0.02, 1e-12);
    EXPECT_NEAR(ate.median, 0.02, 1e-12);
    EXPECT_NEAR(ate.std, 0.01, 1e-12);
    EXPECT_NEAR(ate.min, 0.01, 1e-12);
    EXPECT_NEAR(ate.max, 0.03, 1e-12);
    EXPECT_NEAR(evaluation.ate->scale, 4.0 / (4.0 + 4 * (0.0001 + 0.0009)), 1e-12);
    EXPECT_EQ(evaluation.pairs, 8u);
    EXPECT_DOUBLE_EQ(evaluation.matched_share, 1.0);
    EXPECT_NEAR(evaluation.path_length_m, 7.0, 1e-12);
    EXPECT_NEAR(evaluation.extent_m, std::sqrt(0.5), 1e-12);
}

TEST(Evaluate, RpeHandChecked) {
    // Steps of 1 m in the truth and of 1.01, 1.02, 1.03, 1.04, 1 m in the estimate, one a second. The tools
    // leave out the pair that ends in the last pose, so the errors are 1, 2, 3, 4 cm: rmse = sqrt(7.5) cm,
    // std = sqrt(1.25) cm.
    const double estimate_x[6] = {0, 1.01, 2.03, 3.06, 4.10, 5.10};
    Trajectory truth, estimate;
    for (int i = 0; i < 6; ++i) {
        truth.push_back(at(i, i, 0, 0));
        estimate.push_back(at(i, estimate_x[i], 0, 0));
    }
    const Evaluation evaluation = evaluate(truth, estimate, {});
    for (const auto& rpe : {evaluation.rpe_frame, evaluation.rpe_1s}) {
        ASSERT_TRUE(rpe);
        EXPECT_EQ(rpe->metres.count, 4u);
        EXPECT_NEAR(rpe->metres.rmse, 0.01 * std::sqrt(7.5), 1e-12);
        EXPECT_NEAR(rpe->metres.mean, 0.025, 1e-12);
        EXPECT_NEAR(rpe->metres.median, 0.025, 1e-12);
        EXPECT_NEAR(rpe->metres.std, 0.01 * std::sqrt(1.25), 1e-12);
        EXPECT_NEAR(rpe->metres.max, 0.04, 1e-12);
        expect_all_near(rpe->degrees, 0.0, 1e-9);
    }
    // Two frames: 0->2, 1->3, 2->4 with 3, 5, 7 cm; 3->5 ends in the last pose.
    const auto two = relative_error(truth, estimate, {2, DeltaUnit::frames}, {});
    ASSERT_TRUE(two);
    EXPECT_EQ(two->metres.count, 3u);
    EXPECT_NEAR(two->metres.mean, 0.05, 1e-12);
    // 3 m along the estimate: 0 -> 3.06, 1.01 -> 4.10 (4.01), 2.03 -> 5.10 is the last pose and left out.
    const auto three_metres = relative_error(truth, estimate, {3, DeltaUnit::metres}, {});
    ASSERT_TRUE(three_metres);
    EXPECT_EQ(three_metres->metres.count, 2u);
    EXPECT_NEAR(three_metres->metres.min, 0.06, 1e-12);
    EXPECT_NEAR(three_metres->metres.max, 0.09, 1e-12);
}

TEST(Evaluate, TruthAgainstItselfIsExact) {
    const Trajectory truth = walk(200, 1);
    const Evaluation evaluation = evaluate(truth, truth, {});
    ASSERT_TRUE(evaluation.ate && evaluation.rpe_frame && evaluation.rpe_1s);
    expect_all_near(evaluation.ate->metres, 0.0, 1e-12);
    EXPECT_NEAR(evaluation.ate->scale, 1.0, 1e-12);
    expect_all_near(evaluation.rpe_frame->metres, 0.0, 1e-12);
    expect_all_near(evaluation.rpe_frame->degrees, 0.0, 1e-9);
    expect_all_near(evaluation.rpe_1s->metres, 0.0, 1e-12);
    // One frame on: 199 pairs, less the one that ends in the last pose.
    EXPECT_EQ(evaluation.rpe_frame->metres.count, 198u);
}

TEST(Evaluate, RigidMotionOfTheEstimateChangesNothing) {
    const Trajectory truth = walk(150, 2);
    Trajectory estimate = truth;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, 0.02);
    for (StampedPose& pose : estimate) {
        Twist noise;
        for (Eigen::Index axis = 0; axis < 6; ++axis) noise(axis) = normal(random);
        pose.world_from_camera = pose.world_from_camera * pose_from_twist(noise);
    }
    const Evaluation before = evaluate(truth, estimate, {});
    const Evaluation after = evaluate(truth, moved(estimate, some_motion()), {});
    EXPECT_GT(before.ate->metres.rmse, 0.01);
    EXPECT_NEAR(before.ate->metres.rmse, after.ate->metres.rmse, 1e-10);
    EXPECT_NEAR(before.ate->scale, after.ate->scale, 1e-10);
    EXPECT_NEAR(before.rpe_1s->metres.rmse, after.rpe_1s->metres.rmse, 1e-10);
    EXPECT_NEAR(before.rpe_1s->degrees.rmse, after.rpe_1s->degrees.rmse, 1e-7);

    // The alignment is the inverse of the motion: it lays both on the same place.
    const Pose recovered = after.ate->truth_from_estimate * some_motion();
    EXPECT_TRUE(recovered.isApprox(before.ate->truth_from_estimate, 1e-9));
}

TEST(Evaluate, ConstantDriftPerFrameIsTheRpe) {
    // The truth goes 1 m forward a frame. The estimate goes 1.1 m and turns by 2 deg. Seen from the second
    // pose, the first lies at (-1, 0, 0) in the truth and at -R' (1.1, 0, 0) in the estimate.
    const double angle = 2 * kDegree;
    const Pose step =
        make_pose({1.1, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
    Trajectory truth, estimate;
    Pose pose = Pose::Identity();
    for (int i = 0; i < 50; ++i) {
        truth.push_back(at(i / 30.0, i, 0, 0));
        estimate.push_back({truth.back().utime, pose});
        pose = pose * step;
    }
    const Evaluation evaluation = evaluate(truth, moved(estimate, some_motion()), {});
    ASSERT_TRUE(evaluation.rpe_frame);
    const double drift = std::hypot(1.1 * std::cos(angle) - 1, 1.1 * std::sin(angle));
    expect_all_near(evaluation.rpe_frame->metres, drift, 1e-9);
    expect_all_near(evaluation.rpe_frame->degrees, 2.0, 1e-6);
    ASSERT_TRUE(evaluation.rpe_1s);
    expect_all_near(evaluation.rpe_1s->degrees, 60.0, 1e-6);
}

TEST(Evaluate, ScaleErrorIsFoundAndCanBeTakenOut) {
    const Trajectory truth = walk(120, 4);
    Trajectory estimate = moved(truth, some_motion());
    for (StampedPose& pose : estimate) pose.world_from_camera.translation() *= 1.25;
    const Evaluation evaluation = evaluate(truth, estimate, {});
    EXPECT_NEAR(evaluation.ate->scale, 0.8, 1e-9);
    EXPECT_GT(evaluation.ate->metres.rmse, 1e-3);
    const Evaluation scaled = evaluate(truth, estimate, {.scale = 0.8});
    expect_all_near(scaled.ate->metres, 0.0, 1e-9);
    expect_all_near(scaled.rpe_frame->metres, 0.0, 1e-9);
    EXPECT_NEAR(scaled.ate->scale, 1.0, 1e-9);
}

TEST(Evaluate, MirrorImageIsNotARotation) {
    Trajectory truth = walk(100, 5), estimate = truth;
    for (StampedPose& pose : estimate) pose.world_from_camera.translation().x() *= -1;
    const Evaluation evaluation = evaluate(truth, estimate, {});
    ASSERT_TRUE(evaluation.ate);
    EXPECT_NEAR(evaluation.ate->truth_from_estimate.linear().determinant(), 1.0, 1e-9);
    EXPECT_GT(evaluation.ate->metres.rmse, 1e-3);
}

TEST(RelativeError, LeavesOutPairsFarFromTheTruthInTime) {
    Trajectory estimate = walk(90, 6), truth = estimate;
    truth.erase(truth.begin() + 30, truth.begin() + 60);
    const auto all = relative_error(estimate, estimate, {1, DeltaUnit::frames}, {});
    const auto gap = relative_error(truth, estimate, {1, DeltaUnit::frames}, {});
    ASSERT_TRUE(all && gap);
    // 31 pairs begin or end in the gap; a truth pose of another frame is no truth for them.
    EXPECT_EQ(all->metres.count, 88u);
    EXPECT_EQ(all->left_out, 0u);
    EXPECT_EQ(gap->metres.count, 88u - 31u);
    EXPECT_EQ(gap->left_out, 31u);
}

/// A camera that moves fast and a perfect estimate of it at 30 Hz; the truth at other moments.
TEST(RelativeError, TruthAtOtherMomentsIsInterpolatedWhereItIsDense) {
    const auto pose_at_time = [](double t) {
        return make_pose({t, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitY())));
    };
    const auto sampled = [&](double rate, double from) {
        Trajectory trajectory;
        for (double t = from; t < 10; t += 1 / rate)
            trajectory.push_back({std::llround(t * 1e6), pose_at_time(t)});
        return trajectory;
    };
    const Trajectory estimate = sampled(30, 0.5);
    for (const double rate : {11.0, 25.0, 30.0, 100.0}) {
        const auto error = relative_error(sampled(rate, 0.01), estimate, {1, DeltaUnit::frames}, {});
        ASSERT_TRUE(error) << rate;
        EXPECT_GT(error->metres.count, 250u) << rate;
        // A frame is 33 mm of way; the nearest pose of a truth at 11 Hz is up to 45 mm away. Poses
        // within 5 ms (5 mm) are taken as they are, as the benchmark's tool does.
        EXPECT_LT(error->metres.rmse, 0.005) << rate;
    }
    const Trajectory sparse = sampled(1, 0.01);
    EXPECT_FALSE(relative_error(sparse, estimate, {1, DeltaUnit::frames}, {}));
    const Evaluation evaluation = evaluate(sparse, estimate, {});
    EXPECT_TRUE(evaluation.ate);
    EXPECT_FALSE(evaluation.rpe_frame);
    EXPECT_THAT(evaluation.why_no_rpe_frame, testing::HasSubstr("poses 1 s apart"));
    // Frames that the sparse truth has poses of are compared over one second all the same.
    const Evaluation same_moments = evaluate(sampled(1, 0.5), estimate, {});
    ASSERT_TRUE(same_moments.rpe_1s);
    EXPECT_LT(same_moments.rpe_1s->metres.rmse, 1e-5);
    EXPECT_GT(same_moments.rpe_1s->left_out, 200u);
}

TEST(RelativeError, SaysWhyItIsMissing) {
    const Trajectory truth = walk(90, 6);
    Trajectory later = truth;
    for (StampedPose& pose : later) pose.utime += 1000000000;
    EXPECT_THAT(why_no_relative_error(truth, later, {1, DeltaUnit::frames}),
                testing::HasSubstr("no poses at the estimate's times"));
    EXPECT_EQ(why_no_relative_error(truth, truth, {100, DeltaUnit::seconds}), "too few pairs that far apart");
    EXPECT_EQ(why_no_relative_error({}, truth, {}), "too few pairs that far apart");
}

TEST(Evaluate, ByIndexWithoutTimestamps) {
    const Trajectory truth = walk(60, 11);
    Trajectory estimate = moved(truth, some_motion());
    for (StampedPose& pose : estimate) pose.utime = 0;
    const Evaluation evaluation = evaluate_by_index(truth, estimate, {.max_difference_s = 5});
    ASSERT_TRUE(evaluation.ate && evaluation.rpe_frame);
    EXPECT_EQ(evaluation.pairs, 60u);
    expect_all_near(evaluation.ate->metres, 0.0, 1e-9);
    expect_all_near(evaluation.rpe_frame->metres, 0.0, 1e-9);
    EXPECT_EQ(evaluation.rpe_frame->metres.count, evaluate(truth, truth, {}).rpe_frame->metres.count);
    EXPECT_FALSE(evaluation.rpe_1s);
    EXPECT_THAT(evaluation.why_no_rpe_1s, testing::HasSubstr("no timestamps"));
    estimate.pop_back();
    EXPECT_THROW(evaluate_by_index(truth, estimate, {}), std::invalid_argument);
}

TEST(RelativeError, RotationUnits) {
    // One degree a frame: 10 deg along the trajectory are ten frames.
    Trajectory trajectory;
    for (int i = 0; i < 40; ++i) {
        const Eigen::AngleAxisd turn(i * kDegree, Eigen::Vector3d::UnitY());
        trajectory.push_back({i * 33333, make_pose({0, 0, 0}, Eigen::Quaterniond(turn))});
    }
    const auto frames = relative_error(trajectory, trajectory, {10, DeltaUnit::frames}, {});
    const auto degrees = relative_error(trajectory, trajectory, {10, DeltaUnit::degrees}, {});
    const auto radians = relative_error(trajectory, trajectory, {10 * kDegree, DeltaUnit::radians}, {});
    ASSERT_TRUE(frames && degrees && radians);
    EXPECT_EQ(frames->metres.count, degrees->metres.count);
    EXPECT_EQ(frames->metres.count, radians->metres.count);
}

TEST(Evaluate, NothingToCompare) {
    const Trajectory truth = walk(100, 7);
    Trajectory later = truth;
    for (StampedPose& pose : later) pose.utime += 1000000000;
    for (const Trajectory& estimate :
         {Trajectory{}, Trajectory{truth[0]}, Trajectory{truth[0], truth[1]}, later}) {
        for (const auto& [a, b] : {std::pair(truth, estimate), std::pair(estimate, truth)}) {
            const Evaluation evaluation = evaluate(a, b, {});
            EXPECT_FALSE(evaluation.ate);
            EXPECT_LT(evaluation.pairs, 3u);
        }
    }
    const Evaluation none = evaluate({}, {}, {});
    EXPECT_FALSE(none.ate || none.rpe_frame || none.rpe_1s);
    EXPECT_EQ(none.matched_share, 0.0);
}

TEST(Evaluate, ShorterThanASecondHasNoRpePerSecond) {
    const Trajectory truth = walk(20, 8);
    const Evaluation evaluation = evaluate(truth, truth, {});
    EXPECT_TRUE(evaluation.ate);
    EXPECT_TRUE(evaluation.rpe_frame);
    EXPECT_FALSE(evaluation.rpe_1s);
}

TEST(Evaluate, EstimateThatStandsStill) {
    const Trajectory truth = walk(60, 9);
    Trajectory estimate = truth;
    for (StampedPose& pose : estimate) pose.world_from_camera = Pose::Identity();
    const Evaluation evaluation = evaluate(truth, estimate, {});
    ASSERT_TRUE(evaluation.ate);
    EXPECT_TRUE(std::isnan(evaluation.ate->scale));
    EXPECT_TRUE(std::isfinite(evaluation.ate->metres.rmse));
}

TEST(Evaluate, OfRepeatedStampsTheLastCounts) {
    const Trajectory truth = walk(10, 10);
    Trajectory estimate = truth;
    StampedPose wrong = truth[4];
    wrong.world_from_camera.translation().x() += 5;
    estimate.insert(estimate.begin() + 4, wrong);
    const Evaluation evaluation = evaluate(truth, estimate, {});
    EXPECT_EQ(evaluation.estimate_poses, 10u);
    expect_all_near(evaluation.ate->metres, 0.0, 1e-12);
}

TEST(Evaluate, BadOptionsAreAllNamed) {
    const EvaluationOptions bad{.max_difference_s = 0, .offset_s = NAN, .scale = -1};
    try {
        evaluate({}, {}, bad);
        FAIL() << "no exception";
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("max_difference_s"), testing::HasSubstr("offset_s"),
                                   testing::HasSubstr("scale")));
    }
}

}  // namespace
}  // namespace planemap
