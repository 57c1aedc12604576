// SPDX-License-Identifier: BSD-3-Clause
#include "messages/session.hpp"

#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

TEST(Session, TheNextOneIsKnownToFollowAndNoOtherIs) {
    const std::int64_t first = random_session();
    std::int64_t session = first;
    for (int i = 0; i < kMostRestarts; ++i) {
        session = next_session(session);
        EXPECT_NE(session, 0);
        EXPECT_TRUE(succeeds(session, first)) << i;
        EXPECT_FALSE(succeeds(first, session)) << i;
    }
    EXPECT_FALSE(succeeds(next_session(session), first)) << "too long ago";
    EXPECT_FALSE(succeeds(first, first));
    EXPECT_FALSE(succeeds(random_session(), first));
}

class State : public testing::Test {
  protected:
    TemporaryFolder folder_;
};

TEST_F(State, EachProcessWithItIsANewSessionThatFollows) {
    const std::int64_t first = session_with_state(folder_ / "state", "map");
    const std::int64_t second = session_with_state(folder_ / "state", "map");
    EXPECT_EQ(second, next_session(first));
    EXPECT_FALSE(succeeds(session_with_state(folder_ / "state", "graph"), second)) << "of another module";
    std::filesystem::remove(folder_ / "state/map.session");
    EXPECT_FALSE(succeeds(session_with_state(folder_ / "state", "map"), second)) << "started anew";
}

TEST_F(State, AFileThatIsNoneIsRefusedByItsName) {
    write_file(folder_ / "map.session", "seven\n");
    try {
        session_with_state(folder_.path(), "map");
        FAIL() << "taken";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("map.session"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace planemap::messages
