// SPDX-License-Identifier: BSD-3-Clause
#include "map/look_intake.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;
using scene::facing;
using scene::Rectangle;

const Rectangle kWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};

/// Keyframes in the map, and what takes looks in to them.
struct Intake {
    LookIntake::Keyframes keyframes;
    LookIntake looks{200};
    MapLosses losses;

    explicit Intake(const std::vector<int>& ids) {
        for (const int id : ids) {
            StoredKeyframe& keyframe = keyframes[id];
            keyframe = stored(100 * id, {scene::region_of(kWall, Pose::Identity())});
            keyframe.id = id;
            keyframe.world_from_camera = camera_at({0.1 * id, 0, 0});
            keyframe.regions[0].number = 0;
        }
    }
    Looked add(const Look& look) { return looks.add(look, keyframes, losses); }
};

Look look_of(int id, int number, int looks, bool is_news = false) {
    Look look;
    look.keyframe_id = id;
    look.keyframe_utime = 100 * id;
    look.number = number;
    look.looks = looks;
    look.utime = 100 * id + 1000 * (number + looks);
    if (is_news) look.regions = {scene::region_of(kWall, Pose::Identity())};
    return look;
}

TEST(LookIntake, MoreLooksOfWhatAKeyframeSawCountOnce) {
    Intake intake({3});
    const Looked looked = intake.add(look_of(3, 0, 3));
    EXPECT_EQ(looked.view, &intake.keyframes.at(3));
    EXPECT_EQ(looked.more, 2);
    EXPECT_FALSE(looked.is_news);
    EXPECT_EQ(intake.add(look_of(3, 0, 3)).more, 0) << "told again";
    EXPECT_EQ(intake.add(look_of(3, 0, 2)).more, 0) << "an older one";
    EXPECT_EQ(intake.losses.looks_refused, 0u);
}

TEST(LookIntake, NewsIsAViewOfItsKeyframeWhereItWasTaken) {
    Intake intake({3});
    Look look = look_of(3, 1, 1, true);
    look.keyframe_from_camera = camera_at({0, 0.2, 0});
    const Looked looked = intake.add(look);
    ASSERT_NE(looked.view, nullptr);
    EXPECT_TRUE(looked.is_news);
    EXPECT_EQ(looked.more, 1);
    EXPECT_EQ(looked.keyframe_id, 3);
    ASSERT_EQ(intake.keyframes.at(3).later.size(), 1u);
    EXPECT_EQ(looked.view->regions.size(), 1u);
    EXPECT_TRUE(looked.view->world_from_camera->isApprox(*intake.keyframes.at(3).world_from_camera *
                                                         look.keyframe_from_camera));
    EXPECT_EQ(intake.add(look_of(3, 1, 4)).more, 3) << "what the news showed was seen again";
}

TEST(LookIntake, OfAKeyframeThatWentTheyAreItsHeirs) {
    Intake intake({1, 2});
    const auto gone = intake.keyframes.extract(1);
    EXPECT_FALSE(intake.looks.knows(look_of(1, 1, 1, true), intake.keyframes));
    intake.looks.redirect(gone.mapped(), intake.keyframes.at(2));
    EXPECT_TRUE(intake.looks.knows(look_of(1, 1, 1, true), intake.keyframes));
    Look look = look_of(1, 1, 1, true);
    look.keyframe_from_camera = camera_at({0, 0.2, 0});
    const Looked looked = intake.add(look);
    ASSERT_NE(looked.view, nullptr);
    EXPECT_EQ(looked.keyframe_id, 2);
    EXPECT_TRUE(looked.view->world_from_camera->isApprox(
        *gone.mapped().world_from_camera * look.keyframe_from_camera, 1e-9))
        << "it was taken where it was taken";
    EXPECT_GT(intake.looks.memory_bytes(), 0u);

    LookIntake other(200);
    other.absorb(std::move(intake.looks));
    EXPECT_TRUE(other.knows(look_of(1, 1, 1, true), intake.keyframes));
}

TEST(LookIntake, RefusesWhatItCannotPlaceAndCountsIt) {
    Intake intake({3});
    Look other_session = look_of(3, 0, 2), nowhere = look_of(3, 0, 2);
    other_session.keyframe_utime = 1;
    nowhere.keyframe_from_camera.translation().x() = 1e9;
    const std::vector<Look> refused{look_of(4, 0, 2), other_session, nowhere, look_of(3, 5, 2)};
    for (const Look& look : refused) EXPECT_EQ(intake.add(look).view, nullptr);
    EXPECT_EQ(intake.losses.looks_refused, refused.size());
    EXPECT_EQ(intake.keyframes.at(3).looks, 1);
    EXPECT_TRUE(intake.keyframes.at(3).later.empty());
}

}  // namespace
}  // namespace planemap::map
