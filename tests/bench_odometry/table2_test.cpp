// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/table2.hpp"

#include <gtest/gtest.h>

namespace planemap::bench_odometry {
namespace {

TEST(Table2, IsMeanAndDeviationOfTheRunsRmse) {
    evaluation::RevisitErrors a, b;
    a.revisits = 9;
    a.metres.rmse = 0.004;
    a.step_metres.rmse = 0.01;
    a.step_degrees.rmse = 1;
    b.revisits = 8;
    b.lost = 1;
    b.metres.rmse = 0.008;
    b.step_metres.rmse = 0.02;
    b.step_degrees.rmse = 2;
    const Table2Line line = summarised({a, b});
    EXPECT_EQ(line.runs, 2);
    EXPECT_EQ(line.revisits, 17);
    EXPECT_EQ(line.lost, 1);
    EXPECT_DOUBLE_EQ(line.ate_m.mean, 0.006);
    EXPECT_DOUBLE_EQ(line.ate_m.std, 0.002);
    EXPECT_DOUBLE_EQ(line.rpe_m.mean, 0.015);
    EXPECT_DOUBLE_EQ(line.rpe_deg.std, 0.5);
    EXPECT_EQ(summarised({}).runs, 0);
}

}  // namespace
}  // namespace planemap::bench_odometry
