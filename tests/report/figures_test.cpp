// SPDX-License-Identifier: BSD-3-Clause
#include "report/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;

const Figure& named(const std::vector<Figure>& figures, const std::string& pointer) {
    return *std::find_if(figures.begin(), figures.end(),
                         [&](const Figure& f) { return f.pointer == pointer; });
}

TEST(Figures, WhatIsNotANumberIsUnknown) {
    const Figure planes{"/planes", "planes"};
    EXPECT_FALSE(value_of(Json(), planes));
    EXPECT_FALSE(value_of(Json::array(), planes));
    EXPECT_FALSE(value_of({{"planes", nullptr}}, planes));
    EXPECT_FALSE(value_of({{"planes", "many"}}, planes));
    EXPECT_EQ(value_of({{"planes", 12}}, planes), 12.0);
    EXPECT_FALSE(value_of({{"coverage", 3}}, {"/coverage/within_2cm", "", FigureKind::kShare}));
    EXPECT_EQ(figure_text(std::nullopt, FigureKind::kBytes), "-");
}

TEST(Figures, StagesOfAnyNameAreFigures) {
    const Json report = {{"stages_ms", {{"map", {{"median", 1.5}}}, {"a/b~c", {{"median", 2.5}}}}}};
    const std::vector<Figure> figures = figures_of(report);
    EXPECT_EQ(value_of(report, named(figures, "/stages_ms/map/median")), 1.5);
    EXPECT_EQ(value_of(report, figures.back()), 2.5);
    EXPECT_EQ(figures_of({{"stages_ms", nullptr}}).size() + 2, figures.size());
}

TEST(Figures, TextHasItsUnit) {
    EXPECT_EQ(figure_text(7512, FigureKind::kBytes), "7.51 kB");
    EXPECT_EQ(figure_text(999, FigureKind::kBytes), "999 B");
    EXPECT_EQ(figure_text(0.866, FigureKind::kShare), "86.6 %");
    EXPECT_EQ(figure_text(0.0133, FigureKind::kMillimetres), "13.30 mm");
    EXPECT_EQ(figure_text(43, FigureKind::kCount), "43");
}

TEST(Figures, AStageThatNeverRanTookNoTimeThatIsKnown) {
    const Json report = {{"stages_ms", {{"octomap", {{"median", 0.0}, {"count", 0}}}}}};
    EXPECT_FALSE(value_of(report, named(figures_of(report), "/stages_ms/octomap/median")));
}

TEST(Figures, SharesChangeByPoints) {
    EXPECT_EQ(change_text(0.8, 0.825, FigureKind::kShare), "+2.5 points");
    EXPECT_EQ(change_text(8, 6, FigureKind::kCount), "-25.0 %");
    EXPECT_EQ(change_text(0, 6, FigureKind::kCount), "");
    EXPECT_EQ(change_text(std::nullopt, 6, FigureKind::kShare), "");
}

}  // namespace
}  // namespace planemap
