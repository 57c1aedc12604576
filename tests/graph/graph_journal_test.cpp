// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "temporary_folder.hpp"

namespace planemap::graph {
namespace {

class GraphJournalTest : public testing::Test {
  protected:
    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "graph.journal";
    messages::Complaints complaints_;
    messages::ModuleStatus status_{"graph"};

    /// Of a camera that moves 10 cm a keyframe, with so many features that a thousand are a large journal.
    static std::vector<std::uint8_t> keyframe(int id) {
        Keyframe keyframe;
        keyframe.id = id;
        keyframe.previous_id = id - 1;
        keyframe.utime = 1000 * (id + 1);
        keyframe.previous_from_camera.translation().x() = 0.1;
        keyframe.features.resize(400);
        for (Feature& feature : keyframe.features) feature.point = {0, 0, 1};
        return messages::to_bytes(messages::to_message(keyframe, id));
    }
    std::vector<keyframe_t> replayed() {
        std::vector<keyframe_t> all;
        GraphJournal(file_).replay(complaints_, [&](const keyframe_t& one) {
            all.push_back(one);
            return true;
        });
        return all;
    }
};

TEST_F(GraphJournalTest, AnotherProcessHasTheKeyframesInTheirOrder) {
    {
        GraphJournal journal(file_);
        for (int id = 0; id < 3; ++id) journal.add(keyframe(id));
    }
    GraphJournal journal(file_);
    std::vector<int> ids;
    const auto newest = journal.replay(complaints_, [&](const keyframe_t& one) {
        ids.push_back(one.id);
        return one.id < 2;
    });
    EXPECT_THAT(ids, testing::ElementsAre(0, 1, 2));
    ASSERT_TRUE(newest);
    EXPECT_EQ(newest->message.id, 1) << "the last that was taken";
    EXPECT_EQ(newest->bytes, keyframe(1));
}

TEST_F(GraphJournalTest, WhatIsNoneIsLeftOutAndSaid) {
    {
        GraphJournal journal(file_);
        journal.add(keyframe(0));
        journal.add(std::vector<std::uint8_t>(10, 1));
        journal.add(keyframe(1));
    }
    EXPECT_EQ(replayed().size(), 2u);
    EXPECT_EQ(complaints_.count(), 1);
}

TEST_F(GraphJournalTest, ItBecomesAsSmallAsTheGraphWhoseEdgesItHas) {
    KeyframeTrajectory graph;
    {
        GraphJournal journal(file_);
        for (int id = 0; id < 1000; ++id) journal.add(keyframe(id));
        for (const int id : {0, 1, 990, 999}) {
            KeyframePose pose{id, 1000 * (id + 1), Pose::Identity()};
            pose.world_from_camera.translation().x() = 0.1 * id;
            graph.keyframes.push_back(pose);
        }
        journal.tend(graph, status_);
    }
    const std::vector<keyframe_t> left = replayed();
    ASSERT_EQ(left.size(), 4u);
    EXPECT_EQ(left[1].previous_id, 0) << "as it was";
    EXPECT_EQ(left[3].id, 999);
    EXPECT_EQ(left[3].previous_id, 990) << "998 went: from the newest before it";
    EXPECT_NEAR(messages::from_message(left[3]).previous_from_camera.translation().x(), 0.9, 1e-6);
}

}  // namespace
}  // namespace planemap::graph
