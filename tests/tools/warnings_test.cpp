// SPDX-License-Identifier: BSD-3-Clause
#include "run/warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace planemap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::ordered_json;

std::vector<OdometryEstimate> estimates_at(double step_s) {
    std::vector<OdometryEstimate> estimates(9);
    for (std::size_t i = 0; i < estimates.size(); ++i)
        estimates[i].utime = static_cast<std::int64_t>(1e6 * step_s * static_cast<double>(i));
    estimates.back().utime += 60000000;  // one pause does not count
    return estimates;
}

TEST(Warnings, FramesFarApart) {
    EXPECT_THAT(warnings_of(estimates_at(0.67), false, {}, Json::object()),
                ElementsAre(HasSubstr("frames are 0.67 s apart (median)")));
    EXPECT_THAT(warnings_of(estimates_at(0.67), true, {}, Json::object()), IsEmpty())
        << "nothing rests on tracking";
    for (const double step_s : {0.033, 0.1, 0.2})
        EXPECT_THAT(warnings_of(estimates_at(step_s), false, {}, Json::object()), IsEmpty()) << step_s;
    EXPECT_THAT(warnings_of({}, false, {}, Json::object()), IsEmpty());
}

TEST(Warnings, MostFramesLost) {
    const auto with = [](int tracked) {
        return warnings_of(estimates_at(0.033), false, {}, {{"frames", 60}, {"tracked", tracked}});
    };
    EXPECT_THAT(with(1), ElementsAre(HasSubstr("only 1 of 60 frames are tracked")));
    EXPECT_THAT(with(29), ElementsAre(HasSubstr("only 29 of 60")));
    EXPECT_THAT(with(0), IsEmpty()) << "is an error already";
    EXPECT_THAT(with(30), IsEmpty());
    EXPECT_THAT(with(60), IsEmpty());
    EXPECT_THAT(
        warnings_of(estimates_at(0.033), false, "59 frames are late", {{"frames", 60}, {"tracked", 1}}),
        ElementsAre(HasSubstr("why not the others: 59 frames are late")));
}

TEST(Warnings, DepthThatIsBentByMoreThanItScatters) {
    const auto with = [](double off_m, double sigma_m = 0.01) {
        return warnings_of(
            estimates_at(0.033), false, {},
            {{"depth_off", {{"range_m", 3}, {"off_m", off_m}, {"sigma_m", sigma_m}, {"noise_m", 0.014}}}});
    };
    EXPECT_THAT(with(0.043), ElementsAre(testing::AllOf(HasSubstr("readings of 3 m are off by 4.3 cm"),
                                                        HasSubstr("planemap-calibrate"))));
    EXPECT_THAT(with(0.013), IsEmpty());
    EXPECT_THAT(with(0.024, 0.025), IsEmpty()) << "it is not certain";
    EXPECT_THAT(warnings_of(estimates_at(0.033), false, {}, {{"depth_off", nullptr}}), IsEmpty());
}

TEST(Warnings, ScaleOffTheTruth) {
    const auto with = [](Json scale, double extent_m) {
        return warnings_of(estimates_at(0.033), false, {},
                           {{"accuracy", {{"scale", scale}, {"extent_m", extent_m}, {"ate_rmse_m", 0.1}}}});
    };
    EXPECT_THAT(with(0.958, 5), ElementsAre(HasSubstr("4.4 % too long")));
    EXPECT_THAT(with(1.05, 5), ElementsAre(HasSubstr("4.8 % too short")));
    EXPECT_THAT(with(1.01, 5), IsEmpty());
    EXPECT_THAT(with(0.5, 0.3), IsEmpty()) << "a camera that hardly moved has no scale";
    EXPECT_THAT(with(nullptr, 5), IsEmpty());
}

}  // namespace
}  // namespace planemap
