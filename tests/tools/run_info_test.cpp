// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/option_list.hpp"
#include "core/version.hpp"
#include "messages/flags.hpp"
#include "results/host.hpp"

namespace planemap {
namespace {

TEST(RunInfo, HasVersionDateHostSeedAndOptions) {
    std::optional<std::uint64_t> seed;
    std::string method = "cells", empty;
    double length_m = 0.1;
    bool quiet = true;
    messages::Flags flags("planemap-test", "A test.");
    flags.add("seed", seed, "of all");
    flags.add("camera", empty, "none given");
    flags.add("q,quiet", quiet, "say nothing");
    OptionList list("Map");
    list.add("method", method, {"cells", "ransac"}, "which");
    list.add("length_m", length_m, kAnyNumber, "how long");
    flags.add(list, "map-");
    nlohmann::ordered_json info = run_info(flags);
    EXPECT_EQ(info["version"], version());
    EXPECT_THAT(info["date"].get<std::string>(),
                testing::MatchesRegex("20[0-9]{2}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
    EXPECT_EQ(info["host"], host_name().value());
    EXPECT_TRUE(info["cpu"].is_null() || !info["cpu"].get<std::string>().empty());
    EXPECT_TRUE(info["seed"].is_null());
    EXPECT_EQ(info["options"].dump(),
              R"({"seed":null,"camera":null,"quiet":true,"map-method":"cells","map-length-m":0.1})");
    seed = 18446744073709551615u;
    EXPECT_EQ(run_info(flags)["seed"], seed.value());
}

}  // namespace
}  // namespace planemap
