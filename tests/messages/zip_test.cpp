// SPDX-License-Identifier: BSD-3-Clause
#include "messages/zip.hpp"

#include <gtest/gtest.h>

namespace planemap::messages {
namespace {

std::vector<std::uint8_t> some_bytes() {
    std::vector<std::uint8_t> bytes(1000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i / 50);
    return bytes;
}

TEST(Zip, ComesBack) {
    const std::vector<std::uint8_t> bytes = some_bytes();
    for (const int level : {1, 12}) {
        const std::vector<std::uint8_t> zipped = zip(bytes, level);
        EXPECT_LT(zipped.size(), bytes.size());
        std::vector<std::uint8_t> back(bytes.size());
        EXPECT_EQ(unzip(zipped, back), Unzipped::kWhole);
        EXPECT_EQ(back, bytes);
    }
    std::vector<std::uint8_t> nothing;
    EXPECT_EQ(unzip(zip(nothing, 12), nothing), Unzipped::kWhole);
}

TEST(Zip, SaysWhatDoesNotFitAndWhatIsCorrupt) {
    const std::vector<std::uint8_t> zipped = zip(some_bytes(), 6);
    std::vector<std::uint8_t> more(1001), less(999), whole(1000);
    EXPECT_EQ(unzip(zipped, more), Unzipped::kShort);
    EXPECT_EQ(unzip(zipped, less), Unzipped::kLong);
    EXPECT_EQ(unzip(std::span(zipped).first(zipped.size() / 2), whole), Unzipped::kCorrupt);
    EXPECT_EQ(unzip({}, whole), Unzipped::kCorrupt);
}

}  // namespace
}  // namespace planemap::messages
