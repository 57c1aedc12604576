// SPDX-License-Identifier: BSD-3-Clause
// The pictures: overhead and perspective.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using scene::corner;
using scene::walk;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Drawings, ShowPlanesAndTrajectory) {
    for (const std::string& svg : {overhead_svg(corner(), walk()), perspective_svg(corner(), walk())}) {
        EXPECT_THAT(svg, HasSubstr("<svg xmlns="));
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr(">3</text>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), Not(HasSubstr(">12</text>")))
        << "a ceiling hides what is below";
    EXPECT_EQ(overhead_svg(corner(), walk()), overhead_svg(corner(), walk()));
}

TEST(Drawings, TellTheLabels) {
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr("<title>plane 3, wall, 3.65 m²</title>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), HasSubstr(">wall (1)</text>"));
    EXPECT_THAT(overhead_svg(corner(), walk()), Not(HasSubstr(">ceiling (1)</text>"))) << "not drawn";
    EXPECT_THAT(perspective_svg(corner(), walk()), HasSubstr("<title>plane 1, floor, 4.00 m²</title>"));
}

/// The attribute of the first element after `after` in the text.
std::string attribute_after(const std::string& svg, const std::string& after, const std::string& name) {
    const auto from = svg.find(name + "=\"", svg.find(after)) + name.size() + 2;
    return svg.substr(from, svg.find('"', from) - from);
}

TEST(Drawings, TheLegendHasTheColoursOfTheDrawingAndCountsAllPlanes) {
    PlaneMap map = corner();
    map.planes.push_back(
        scene::plane_of(20, {scene::facing({0.5, 0.5, 0.7}, {0, 0, 1}, {1, 0, 0}), 0.1, 0.1, {}}));
    map.planes.back().label = PlaneLabel::kHorizontal;
    map.planes.push_back(scene::plane_of(21, {scene::facing({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}}));
    map.planes.back().outline = {};
    const std::string svg = overhead_svg(map, walk());
    for (const char* text :
         {">5 planes from above</text>", ">floor (1)</text>", ">ceiling (1), not drawn</text>",
          ">horizontal (1)</text>", ">1 plane not drawn: seen from below</text>",
          ">1 without number: under 0.15 m²</text>", ">1 without outline</text>"})
        EXPECT_THAT(svg, HasSubstr(text));
    // The floor is filled with what the legend shows beside its word, the wall's line drawn with its own.
    const auto floor_at = svg.find("plane 1, floor");
    const auto shape = svg.rfind("<path", floor_at);
    const std::string fill = attribute_after(svg.substr(shape), "evenodd", "fill");
    const auto swatch = svg.rfind("<rect", svg.find(">floor (1)</text>"));
    EXPECT_EQ(attribute_after(svg.substr(swatch), "<rect", "fill"), fill);
    const auto wall = svg.rfind("<path", svg.find("plane 3, wall"));
    const auto wall_swatch = svg.rfind("<rect", svg.find(">wall (1)</text>"));
    EXPECT_EQ(attribute_after(svg.substr(wall), "<path", "stroke"),
              attribute_after(svg.substr(wall_swatch), "<rect", "fill"));
    // Beside the drawing: no shape reaches as far right as the legend.
    const double legend_x = std::stod(attribute_after(svg.substr(swatch), "<rect", "x"));
    for (auto at = svg.find(" d=\"M"); at != std::string::npos; at = svg.find(" d=\"M", at + 1)) {
        const std::string d = attribute_after(svg.substr(at), " d", "d");
        if (d.find('h') != std::string::npos) continue;  // the legend's own line
        for (auto i = d.find_first_of("ML"); i != std::string::npos; i = d.find_first_of("ML", i + 1))
            EXPECT_LT(std::stod(d.substr(i + 1)), legend_x) << d;
    }
}

TEST(Drawings, HaveATitleAndAScale) {
    const std::string above = overhead_svg(corner(), walk()), perspective = perspective_svg(corner(), walk());
    EXPECT_THAT(above, HasSubstr(">0.5 m</text>"));
    EXPECT_THAT(perspective, HasSubstr(">3 planes in perspective</text>"));
    EXPECT_THAT(perspective, HasSubstr(">0.5 m</text>"));
    PlaneMap unknown = corner();
    unknown.up.setZero();
    EXPECT_THAT(overhead_svg(unknown, walk()), HasSubstr("up: as the camera was held"));
}

TEST(Drawings, LeaveOutWhatIsNotFinite) {
    PlaneMap map = corner();
    map.planes[0].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    for (const std::string& svg : {overhead_svg(map, walk()), perspective_svg(map, walk())}) {
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("plane 1,")));
        EXPECT_THAT(svg, HasSubstr("plane 3,"));
    }
}

TEST(Drawings, OfAnEmptyMap) {
    for (const std::string& svg : {overhead_svg({}, {}), perspective_svg({}, {}), overhead_svg({}, walk())}) {
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
        EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
}

}  // namespace
}  // namespace planemap::exports
