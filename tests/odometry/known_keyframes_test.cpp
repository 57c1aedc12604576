// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/known_keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/random_values.hpp"

namespace planemap::odometry {
namespace {

/// Views of places: another number, other descriptors; a likeness shares some of them.
class KnownKeyframesTest : public testing::Test {
  protected:
    static std::vector<Descriptor> look(int number, int features = 40) {
        test::Random random(static_cast<unsigned>(1 + number));
        std::vector<Descriptor> descriptors(static_cast<std::size_t>(features));
        for (Descriptor& descriptor : descriptors)
            for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.integer(0, 255));
        return descriptors;
    }
    static void add(KnownKeyframes& known, int id, double x, int number, int previous_id) {
        places::KeyframeView view;
        view.descriptors = look(number);
        view.points.assign(view.descriptors.size(), Eigen::Vector3d(0, 0, 1));
        Pose pose = Pose::Identity();
        pose.translation().x() = x;
        known.add(id, previous_id, pose, std::move(view));
    }
    static std::vector<int> ids(const std::vector<KnownKeyframes::Candidate>& candidates) {
        std::vector<int> ids;
        for (const auto& candidate : candidates) ids.push_back(candidate.keyframe->id);
        return ids;
    }
    /// All that are there.
    static std::vector<int> all(const KnownKeyframes& known, int up_to) {
        std::vector<int> ids;
        for (int id = 0; id <= up_to; ++id)
            if (known.find(id)) ids.push_back(id);
        return ids;
    }
};

TEST_F(KnownKeyframesTest, TheNewestComesFirstThenTheMostAlike) {
    KnownKeyframes known(10);
    for (int i = 1; i <= 4; ++i) add(known, i, i, i, i - 1);
    EXPECT_EQ(ids(known.candidates(look(2))), (std::vector{4, 2}));
    std::vector<Descriptor> mixed = look(1, 10);
    const std::vector<Descriptor> more = look(3, 30);
    mixed.insert(mixed.end(), more.begin(), more.end());
    const auto candidates = known.candidates(mixed);
    EXPECT_EQ(ids(candidates), (std::vector{4, 3, 1}));
    EXPECT_GT(candidates[1].score, 2 * candidates[2].score);
    EXPECT_EQ(candidates[0].score, 0);
}

TEST_F(KnownKeyframesTest, NoneAreNone) {
    KnownKeyframes known(10);
    EXPECT_TRUE(known.candidates(look(1)).empty());
    add(known, 0, 0, 1, -1);
    EXPECT_EQ(known.candidates({}).size(), 1u) << "the newest";
    known.clear();
    EXPECT_TRUE(known.candidates(look(1)).empty());
    EXPECT_EQ(known.find(0), nullptr);
    add(known, 0, 0, 1, -1);
    EXPECT_EQ(known.candidates(look(1)).size(), 1u);
}

TEST_F(KnownKeyframesTest, OfTheNearestTwoTheOlderGoes) {
    KnownKeyframes known(14);
    // 0, 1, 2, 3 a metre apart but for 2, which is near 1; then more than ten far ones.
    const double at[] = {0, 1, 1.1, 3};
    for (int i = 0; i < 15; ++i) add(known, i, i < 4 ? at[i] : 10 * i, i, i - 1);
    EXPECT_EQ(known.find(1), nullptr);
    EXPECT_EQ(all(known, 15).size(), 14u);
    for (const auto& candidate : known.candidates(look(1)))
        EXPECT_LT(candidate.score, 0.1) << "what went is not found any more";
}

TEST_F(KnownKeyframesTest, KeyframesOfTwoPartsAreNotNear) {
    KnownKeyframes known(13);
    add(known, 0, 0, 0, -1);
    add(known, 1, 0.01, 1, -1);
    add(known, 2, 5, 2, 1);
    add(known, 3, 6, 3, 2);
    for (int i = 4; i < 14; ++i) add(known, i, 10 * i, i, i - 1);
    EXPECT_NE(known.find(0), nullptr);
    EXPECT_EQ(known.find(2), nullptr);
}

TEST_F(KnownKeyframesTest, TheNewestTenStay) {
    KnownKeyframes known(12);
    for (int i = 0; i < 40; ++i) {
        add(known, i, 0, i, i - 1);  // all in one place
        const std::vector<int> left = all(known, i);
        EXPECT_LE(left.size(), 12u);
        const std::set<int> stay(left.begin(), left.end());
        for (int k = std::max(0, i - 9); k <= i; ++k) EXPECT_TRUE(stay.contains(k)) << k << " of " << i;
    }
}

TEST_F(KnownKeyframesTest, ASmallCapacityIsKept) {
    KnownKeyframes known(1);
    for (int i = 0; i < 5; ++i) add(known, i, i, i, i - 1);
    EXPECT_EQ(all(known, 5).size(), 1u);
}

TEST_F(KnownKeyframesTest, AroundOneAreThoseOfItsPartMadeAboutThen) {
    KnownKeyframes known(100);
    for (int i = 0; i < 60; ++i) add(known, i, i, i, i == 25 ? -1 : i - 1);
    const auto ids_around = [&](int id) {
        std::vector<int> ids;
        for (const KnownKeyframe* keyframe : known.around(*known.find(id))) ids.push_back(keyframe->id);
        return ids;
    };
    EXPECT_EQ(ids_around(20).front(), 0);
    EXPECT_EQ(ids_around(20).back(), 24);
    EXPECT_EQ(ids_around(30).front(), 25);
    EXPECT_EQ(ids_around(30).back(), 50);
}

TEST_F(KnownKeyframesTest, OneThatGoesOnFromOneThatWentIsOfTheNewestsPart) {
    KnownKeyframes known(100);
    add(known, 0, 0, 0, -1);
    add(known, 5, 1, 1, -1);
    add(known, 6, 2, 2, 3);
    EXPECT_EQ(known.find(6)->part, known.find(5)->part);
    EXPECT_NE(known.find(6)->part, known.find(0)->part);
}

}  // namespace
}  // namespace planemap::odometry
