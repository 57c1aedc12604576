// SPDX-License-Identifier: BSD-3-Clause
#include "core/validation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace planemap {
namespace {

TEST(FieldErrors, SilentWhenAllIsWell) {
    FieldErrors errors("Options");
    errors.require(true, "a", 1.0, "anything");
    errors.require(true, "b", "text", "anything");
    EXPECT_FALSE(errors.any());
    EXPECT_NO_THROW(errors.throw_if_any());
}

TEST(FieldErrors, OneErrorNamesEveryBadField) {
    FieldErrors errors("Options");
    errors.require(false, "count", -3, "at least 0");
    errors.require(true, "fine", 1, "at least 0");
    errors.require(false, "ratio", std::numeric_limits<double>::quiet_NaN(), "finite");
    errors.require(false, "method", "magic", "ransac or cells");
    EXPECT_TRUE(errors.any());
    try {
        errors.throw_if_any();
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "Options: count is -3, must be at least 0; ratio is nan, must be finite; "
                     "method is magic, must be ransac or cells");
    }
}

}  // namespace
}  // namespace planemap
