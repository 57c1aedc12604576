// SPDX-License-Identifier: BSD-3-Clause
#include "places/verification.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "places/synthetic.hpp"

namespace planemap::places {
namespace {

using namespace planemap::test;

class VerificationTest : public testing::Test {
  protected:
    Keyframe keyframe_at(const Pose& pose) {
        Keyframe keyframe;
        keyframe.features = see(room_, pose, random_);
        return keyframe;
    }
    KeyframeView view_at(const Pose& pose) { return make_view(keyframe_at(pose), 1000); }

    Random random_{1};
    std::vector<Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 1500);
    Pose here_ = looking(Eigen::Vector3d(0.1, 0, -0.3), 0);
    Pose there_ = looking(Eigen::Vector3d(0.4, 0.1, 0.0), 0.25);
};

TEST_F(VerificationTest, FindsThePoseAndAHonestCovariance) {
    double chi_squared = 0;
    constexpr int kTries = 20;
    for (int i = 0; i < kTries; ++i) {
        const Pose there = there_ * pose_from_twist(0.1 * Twist::Random());
        const Verification found = verify(view_at(here_), view_at(there), {}, 7);
        ASSERT_EQ(found.verdict, Verdict::kAccepted);
        const Pose truth = here_.inverse() * there;
        const Twist error = twist_from_pose(found.a_from_b.inverse() * truth);
        EXPECT_LT(error.head<3>().norm(), 0.02);
        EXPECT_LT(error.tail<3>().norm(), 0.008);
        EXPECT_GT(found.inliers, 60);
        EXPECT_TRUE(is_valid(found.a_from_b));
        chi_squared += error.dot(found.covariance.ldlt().solve(error)) / kTries;
    }
    EXPECT_GT(chi_squared, 6 / 4.0);
    EXPECT_LT(chi_squared, 6 * 4.0);
}

TEST_F(VerificationTest, SurvivesManyWrongMatches) {
    const KeyframeView a = view_at(here_);
    KeyframeView b = view_at(there_);
    for (std::size_t i = 0; i < b.points.size(); ++i) {
        if (random_.uniform(0, 1) < 0.4) b.points[i] = random_.vector(1) + Eigen::Vector3d(0, 0, 2.5);
    }
    const Verification found = verify(a, b, {}, 7);
    ASSERT_EQ(found.verdict, Verdict::kAccepted);
    EXPECT_LT(twist_from_pose(found.a_from_b.inverse() * here_.inverse() * there_).norm(), 0.03);
}

TEST_F(VerificationTest, SameSeedSameBytes) {
    const KeyframeView a = view_at(here_), b = view_at(there_);
    const Verification one = verify(a, b, {}, 3), two = verify(a, b, {}, 3);
    EXPECT_EQ(one.a_from_b.matrix(), two.a_from_b.matrix());
    EXPECT_EQ(one.covariance, two.covariance);
}

TEST_F(VerificationTest, OtherDescriptorsAreNoLoop) {
    const KeyframeView a = view_at(here_);
    KeyframeView b = view_at(there_);
    for (auto& descriptor : b.descriptors) descriptor = random_descriptor(random_);
    EXPECT_EQ(verify(a, b, {}, 7).verdict, Verdict::kFewMatches);
}

TEST_F(VerificationTest, SameLooksWithAnotherShapeAreNoLoop) {
    const KeyframeView a = view_at(here_);
    KeyframeView b = view_at(here_);
    for (auto& p : b.points) p = random_.vector(1) + Eigen::Vector3d(0, 0, 2.5);
    EXPECT_EQ(verify(a, b, {}, 7).verdict, Verdict::kFewInliers);
}

TEST_F(VerificationTest, OnePosterIsNotARoom) {
    // All that the two views share is a patch of 0.6 m.
    const auto poster = [&](Random& random) {
        std::vector<Landmark> landmarks;
        for (int i = 0; i < 80; ++i)
            landmarks.push_back(
                {{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 2.4}, random_descriptor(random)});
        return landmarks;
    }(random_);
    auto first = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 1000),
         second = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 1000);
    first.insert(first.begin(), poster.begin(), poster.end());
    second.insert(second.begin(), poster.begin(), poster.end());
    Keyframe a, b;
    a.features = see(first, here_, random_);
    b.features = see(second, here_, random_);
    EXPECT_NE(verify(make_view(a, 1000), make_view(b, 1000), {}, 7).verdict, Verdict::kAccepted);
}

TEST_F(VerificationTest, ASurfaceThatTheOtherSawThroughIsAVeto) {
    KeyframeView a = view_at(here_), b = view_at(here_);
    a.regions = {wall(2.7)};
    b.regions = {wall(2.7)};
    const Verification agreed = verify(a, b, {}, 7);
    EXPECT_EQ(agreed.verdict, Verdict::kAccepted);
    EXPECT_EQ(agreed.planes, 1);
    b.regions = {wall(1.2)};  // here stands a wall through which a saw the other
    EXPECT_EQ(verify(a, b, {}, 7).verdict, Verdict::kContradiction);
    EXPECT_EQ(verify(b, a, {}, 7).verdict, Verdict::kContradiction);
}

TEST_F(VerificationTest, PlanesSharpenTheRotation) {
    KeyframeView a = view_at(here_), b = view_at(here_);
    const Matrix6d without = verify(a, b, {}, 7).covariance;
    a.regions = b.regions = {wall(2.7)};
    const Matrix6d with = verify(a, b, {}, 7).covariance;
    EXPECT_LT(with(3, 3), without(3, 3));
    EXPECT_LT(with(4, 4), without(4, 4));
}

/// A wall with a pattern that comes again every `period` metres along it; 0: never.
std::vector<Landmark> papered(Random& random, double period) {
    std::vector<Landmark> landmarks;
    for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d p(random.uniform(0, 0.7), random.uniform(-1, 1), 2.4);
        Descriptor descriptor = random_descriptor(random);
        for (int strip = -3; strip <= 3; ++strip) {
            if (period == 0) descriptor = random_descriptor(random);
            landmarks.push_back(
                {p + Eigen::Vector3d((period == 0 ? 0.7 : period) * strip, 0, 0), descriptor});
        }
    }
    return landmarks;
}

TEST_F(VerificationTest, APatternThatComesAgainIsNoPlace) {
    for (int seed = 0; seed < 5; ++seed) {
        const Pose there = here_ * pose_from_twist(0.05 * Twist::Random());
        for (const double period : {0.0, 0.7}) {
            const std::vector<Landmark> paper = papered(random_, period);
            Keyframe a, b;
            a.features = see(paper, here_, random_);
            b.features = see(paper, there, random_);
            const Verification found = verify(make_view(a, 1000), make_view(b, 1000), {}, 7);
            if (period == 0)
                EXPECT_EQ(found.verdict, Verdict::kAccepted);
            else
                EXPECT_NE(found.verdict, Verdict::kAccepted);
        }
    }
}

TEST_F(VerificationTest, AStepAlongAPatternIsAmbiguousThoughOneStripIsTheNearest) {
    const std::vector<Landmark> paper = papered(random_, 0.7);
    Keyframe a, b;
    a.features = see(paper, here_, random_);
    b.features = see(paper, here_, random_);
    // What is at the same place happens to have the same descriptor to the last bit: matching takes it.
    for (Feature& feature : b.features) {
        const Feature* nearest = &a.features.front();
        for (const Feature& other : a.features)
            if ((other.pixel - feature.pixel).norm() < (nearest->pixel - feature.pixel).norm())
                nearest = &other;
        feature.descriptor = nearest->descriptor;
    }
    const KeyframeView view_a = make_view(a, 1000), view_b = make_view(b, 1000);
    EXPECT_EQ(verify(view_a, view_b, {}, 7).verdict, Verdict::kAmbiguous);
    VerificationOptions any;
    any.must_be_unique = false;
    EXPECT_EQ(verify(view_a, view_b, any, 7).verdict, Verdict::kAccepted);
}

TEST(PlacesApart, ByMetresOrDegrees) {
    Twist twist = Twist::Zero();
    EXPECT_FALSE(are_apart(Pose::Identity(), Pose::Identity()));
    twist << 0.29, 0, 0, 0, 0, 0;
    EXPECT_FALSE(are_apart(Pose::Identity(), pose_from_twist(twist)));
    twist << 0, 0.31, 0, 0, 0, 0;
    EXPECT_TRUE(are_apart(Pose::Identity(), pose_from_twist(twist)));
    twist << 0, 0, 0, 0, 0.17, 0;
    EXPECT_FALSE(are_apart(Pose::Identity(), pose_from_twist(twist)));
    twist << 0, 0, 0, 0, 0.18, 0;
    EXPECT_TRUE(are_apart(pose_from_twist(twist), Pose::Identity()));
}

TEST(Rivals, NeedLessThanWhatTheySpeakAgainst) {
    Verification found;
    found.inliers = 1000;
    EXPECT_EQ(rival_options({}, found).min_inliers, VerificationOptions{}.min_inliers);
    found.inliers = 30;
    EXPECT_LT(rival_options({}, found).min_inliers, 15);
    EXPECT_GE(rival_options({}, found).min_inliers, 10) << "so many agree by chance";
    EXPECT_LT(rival_options({}, found).min_cells, VerificationOptions{}.min_cells);
    EXPECT_FALSE(rival_options({}, found).must_be_unique);
    VerificationOptions strict;
    strict.min_inliers = 5;
    EXPECT_LE(rival_options(strict, found).min_inliers, 5);
}

TEST_F(VerificationTest, DegenerateViews) {
    const KeyframeView a = view_at(here_);
    EXPECT_EQ(verify(a, KeyframeView{}, {}, 7).verdict, Verdict::kFewMatches);
    EXPECT_EQ(verify(KeyframeView{}, a, {}, 7).verdict, Verdict::kFewMatches);
    EXPECT_EQ(verify(KeyframeView{}, KeyframeView{}, {}, 7).verdict, Verdict::kFewMatches);
    KeyframeView point = a, line = a;
    for (auto& p : point.points) p = {0, 0, 2};
    for (std::size_t i = 0; i < line.points.size(); ++i)
        line.points[i] = {0.01 * static_cast<double>(i), 0, 2};
    EXPECT_NE(verify(point, point, {}, 7).verdict, Verdict::kAccepted);
    EXPECT_NE(verify(line, line, {}, 7).verdict, Verdict::kAccepted) << "the turn about the line is open";
    KeyframeView huge = a;
    PlanarRegion region = wall(2);
    region.box.half_extents.x() = std::numeric_limits<double>::max();
    region.plane.d = std::numeric_limits<double>::max();
    huge.regions = {region};
    verify(huge, huge, {}, 7);
}

}  // namespace
}  // namespace planemap::places
