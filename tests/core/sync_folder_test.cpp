// SPDX-License-Identifier: BSD-3-Clause
#include "core/sync_folder.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap {
namespace {

TEST(SyncFolder, SaysWhatFailed) {
    const TemporaryFolder folder;
    EXPECT_EQ(sync_folder(folder.path()), 0);
    EXPECT_EQ(sync_folder(folder / "none"), ENOENT);
    EXPECT_EQ(sync_folder(folder.write("file", "")), ENOTDIR);
}

}  // namespace
}  // namespace planemap
