// SPDX-License-Identifier: BSD-3-Clause
#include "map/edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/crossing.hpp"

namespace planemap::map {
namespace {

constexpr double kCell_m = 0.025;

/// The cells whose centre satisfies `inside`, within 4 m x 3 m around the origin.
template <typename Inside>
Bitmap shape_of(const Inside& inside) {
    Bitmap shape(-3, -64, 6, 128);
    for (int y = -60; y < 60; ++y)
        for (int x = -80; x < 80; ++x) shape.set(x, y, inside(kCell_m * Eigen::Vector2d(x + 0.5, y + 0.5)));
    return shape;
}

Bitmap rectangle(double x0, double y0, double x1, double y1) {
    return shape_of(
        [&](const Eigen::Vector2d& p) { return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1; });
}

/// Of a shape of which nothing is certain.
void end_at(const MeetingLine& line, Bitmap& shape) {
    const Bitmap none(shape.word0(), shape.y0(), shape.words(), shape.rows());
    end_at(line, kCell_m, none, shape);
}

Outline traced(const Bitmap& shape) {
    Outline outline = shape.trace();
    for (Ring& ring : outline.rings)
        for (Eigen::Vector2d& v : ring) v *= kCell_m;
    return outline;
}

Outline outline_at(Bitmap shape, const std::vector<MeetingLine>& lines) {
    for (const MeetingLine& line : lines) end_at(line, shape);
    return with_straight_edges(traced(shape), lines, {kCell_m, 0.05, 0.005});
}

double distance_to_line(const Eigen::Vector2d& p, const MeetingLine& line) {
    const Eigen::Vector2d along = (line.to - line.from).normalized();
    return std::abs(along.x() * (p - line.from).y() - along.y() * (p - line.from).x());
}

TEST(EndAt, AShapeThatEndsBeforeTheLineIsContinued) {
    Bitmap shape = rectangle(-1, -0.5, 1, 0.45);
    const auto before = shape.count();
    end_at({{-1, 0.5}, {1, 0.5}, 0.06}, shape);
    EXPECT_EQ(shape.count(), before + 2 * 80) << "two rows of cells";
}

TEST(EndAt, OneThatStandsOutIsCut) {
    Bitmap shape = rectangle(-1, -0.5, 1, 0.55);
    const auto before = shape.count();
    end_at({{-1, 0.5}, {1, 0.5}, 0.06}, shape);
    EXPECT_EQ(shape.count(), before - 2 * 80);
}

TEST(EndAt, OnlyWhereTheOtherPlaneIs) {
    Bitmap shape = rectangle(-1, -0.5, 1, 0.45);
    const auto before = shape.count();
    end_at({{-1, 0.5}, {0, 0.5}, 0.06}, shape);
    EXPECT_NEAR(static_cast<double>(shape.count()), static_cast<double>(before + 2 * 40), 2);
}

TEST(EndAt, WhatGoesThroughOrEndsFartherOffStays) {
    for (const double end : {0.4, 0.9}) {
        Bitmap shape = rectangle(-1, -0.5, 1, end);
        const auto before = shape.count();
        end_at({{-1, 0.5}, {1, 0.5}, 0.06}, shape);
        EXPECT_EQ(shape.count(), before) << end;
    }
}

TEST(EndAt, WhatIsCertainIsNotCutOffButForTeeth) {
    const Bitmap shape = rectangle(-1, -0.5, 1, 0.55);
    const MeetingLine line{{-1, 0.5}, {1, 0.5}, 0.06};
    Bitmap overhang = shape;
    end_at(line, kCell_m, rectangle(0, -0.5, 1, 0.55), overhang);
    EXPECT_NEAR(static_cast<double>(overhang.count()), static_cast<double>(shape.count() - 2 * 40), 4);
    Bitmap tooth = shape;
    end_at(line, kCell_m, rectangle(0, -0.5, 0.05, 0.55), tooth);
    EXPECT_EQ(tooth.count(), shape.count() - 2 * 80);
}

TEST(EndAt, BesideTheBitmapOrWithoutLengthIsNothing) {
    Bitmap shape = rectangle(-1, -0.5, 1, 0.45);
    const auto before = shape.count();
    end_at({{50, 0.5}, {52, 0.5}, 0.06}, shape);
    end_at({{0, 0.5}, {0, 0.5}, 0.06}, shape);
    end_at({{-1, 0.5}, {1, 0.5}, 0}, shape);
    EXPECT_EQ(shape.count(), before);
    Bitmap empty;
    end_at({{-1, 0.5}, {1, 0.5}, 0.06}, empty);
    EXPECT_EQ(empty.count(), 0u);
}

TEST(StraightEdges, ARectangleHasFourVerticesHoweverItLies) {
    for (int trial = 0; trial < 24; ++trial) {
        const double angle = trial * std::numbers::pi / 24;
        const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
        const Bitmap shape = shape_of(
            [&](const Eigen::Vector2d& p) { return std::abs(x.dot(p)) < 0.9 && std::abs(y.dot(p)) < 0.4; });
        const Outline outline = outline_at(shape, {});
        ASSERT_EQ(outline.rings.size(), 1u);
        EXPECT_EQ(outline.rings[0].size(), 4u) << angle;
        EXPECT_NEAR(area(outline), area(traced(shape)), 0.01) << angle;
        for (const Eigen::Vector2d& v : outline.rings[0]) {
            EXPECT_NEAR(std::abs(x.dot(v)), 0.9, 0.02) << angle;
            EXPECT_NEAR(std::abs(y.dot(v)), 0.4, 0.02) << angle;
        }
    }
}

TEST(StraightEdges, AFloorBetweenFourWallsHasItsCornersWhereTheyMeet) {
    for (int trial = 0; trial < 12; ++trial) {
        const double angle = 0.1 + trial * std::numbers::pi / 12;
        const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
        const auto at = [&](double a, double b) -> Eigen::Vector2d { return a * x + b * y; };
        const std::vector<MeetingLine> walls{{at(-1, -0.7), at(1, -0.7), 0.08},
                                             {at(1, -0.7), at(1, 0.7), 0.08},
                                             {at(1, 0.7), at(-1, 0.7), 0.08},
                                             {at(-1, 0.7), at(-1, -0.7), 0.08}};
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> ragged(-0.05, 0.05);
        std::vector<double> ends(200);
        for (double& end : ends) end = ragged(random);
        // Ends up to 5 cm before the walls or behind them.
        const Outline outline = outline_at(shape_of([&](const Eigen::Vector2d& p) {
                                               const double a = x.dot(p), b = y.dot(p);
                                               const auto end = [&](double place) {
                                                   return ends[static_cast<std::size_t>((place + 3) * 20)];
                                               };
                                               return std::abs(a) < 1 + end(b) && std::abs(b) < 0.7 + end(a);
                                           }),
                                           walls);
        ASSERT_EQ(outline.rings.size(), 1u);
        EXPECT_EQ(outline.rings[0].size(), 4u) << angle;
        for (const Eigen::Vector2d& v : outline.rings[0]) {
            EXPECT_NEAR(std::abs(x.dot(v)), 1, 1e-6) << angle;
            EXPECT_NEAR(std::abs(y.dot(v)), 0.7, 1e-6) << angle;
        }
    }
}

TEST(StraightEdges, AnEdgeOnALineHasTwoVerticesOnIt) {
    const MeetingLine wall{{-0.6, 0.3}, {0.8, 0.37}, 0.08};
    const Outline outline = outline_at(rectangle(-1.2, -0.5, 1.2, 0.34), {wall});
    int on = 0;
    for (const Ring& ring : outline.rings)
        for (const Eigen::Vector2d& v : ring) on += distance_to_line(v, wall) < 1e-6;
    EXPECT_EQ(on, 2);
    EXPECT_FALSE(rings_cross(outline));
}

TEST(StraightEdges, AnyShapeStaysWithinTheToleranceAndItsRingsDoNotCross) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> c(-1.2, 1.2), size(0.05, 0.6);
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<Eigen::Vector4d> discs;
        for (int i = 0; i < 8; ++i) discs.emplace_back(c(random), c(random), size(random), i % 3);
        const Bitmap shape = shape_of([&](const Eigen::Vector2d& p) {
            bool inside = false;
            for (const Eigen::Vector4d& d : discs)
                if ((p - d.head<2>()).cwiseAbs().maxCoeff() < d.z()) inside = d.w() != 2;
            return inside;
        });
        std::vector<MeetingLine> lines;
        for (int i = 0; i < 4; ++i)
            lines.push_back({{c(random), c(random)}, {c(random), c(random)}, size(random) / 4});
        const Outline free = outline_at(shape, {});
        EXPECT_FALSE(rings_cross(free)) << trial;
        EXPECT_FALSE(rings_cross(outline_at(shape, lines))) << trial;
        const Outline cells = traced(shape);
        for (const Ring& ring : free.rings) {
            for (const Eigen::Vector2d& v : ring) {
                double nearest = 1e9;
                for (const Ring& other : cells.rings)
                    for (const Eigen::Vector2d& w : other) nearest = std::min(nearest, (v - w).norm());
                EXPECT_LT(nearest, 0.05 + kCell_m) << trial;
            }
        }
        EXPECT_NEAR(area(free), area(cells), 0.04 * area(cells) + 0.02) << trial;
    }
}

TEST(StraightEdges, TeethAndNotchesGo) {
    const Bitmap shape = shape_of([](const Eigen::Vector2d& p) {
        const bool tooth = std::abs(p.x()) < 0.03 && p.y() < 0.65,
                   notch = std::abs(p.x() - 0.5) < 0.03 && p.y() > 0.4;
        return std::abs(p.x()) < 1 && p.y() > -0.5 && (p.y() < 0.5 || tooth) && !notch;
    });
    EXPECT_GT(with_straight_edges(traced(shape), {}, {kCell_m, 0.04, 0}).vertex_count(), 4u);
    const Outline straight = with_straight_edges(traced(shape), {}, {kCell_m, 0.04, 0.005});
    EXPECT_EQ(straight.vertex_count(), 4u);
    EXPECT_NEAR(area(straight), 2, 0.02);
}

TEST(StraightEdges, OfNothing) {
    EXPECT_TRUE(with_straight_edges({}, {}, {}).empty());
    EXPECT_TRUE(with_straight_edges({}, {{{0, 0}, {1, 0}, 0.1}}, {}).empty());
}

}  // namespace
}  // namespace planemap::map
