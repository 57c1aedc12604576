// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

namespace planemap::benchmark {
namespace {

TEST(ScratchFolder, IsEmptyAndItsOwnAndGoesWithAllThatIsInIt) {
    std::optional<ScratchFolder> one("planemap-scratch-test");
    const ScratchFolder other("planemap-scratch-test");
    EXPECT_NE(one->path(), other.path());
    EXPECT_TRUE(std::filesystem::is_empty(other.path()));
    const std::filesystem::path path = one->path();
    std::filesystem::create_directories(path / "deeper");
    std::ofstream(path / "deeper/file") << "something";
    one.reset();
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(other.path()));
}

TEST(ScratchFolder, ThatCannotBeMadeIsNamed) {
    EXPECT_THROW(ScratchFolder("no-such-folder/scratch"), std::runtime_error);
}

}  // namespace
}  // namespace planemap::benchmark
