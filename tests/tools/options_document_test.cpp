// SPDX-License-Identifier: BSD-3-Clause
#include "options/options_document.hpp"

#include <gtest/gtest.h>

#include "core/files.hpp"

namespace planemap {
namespace {

TEST(OptionsDocument, IsWhatTheListsSay) {
    EXPECT_TRUE(read_file(std::string(PLANEMAP_SOURCE) + "/docs/options.md") == options_document())
        << "docs/options.md is of other options: `ninja options_document` writes it anew";
}

}  // namespace
}  // namespace planemap
