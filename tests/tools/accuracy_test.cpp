// SPDX-License-Identifier: BSD-3-Clause
#include "run/accuracy.hpp"

#include <gtest/gtest.h>

#include "core/random_values.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

Trajectory some_poses() {
    test::Random random(5);
    Trajectory trajectory;
    for (int i = 0; i < 30; ++i) trajectory.push_back({1500000000000000 + 33333 * i, random.pose()});
    return trajectory;
}

TEST(IsPartOf, GoesByWhatIsInTheFileNotByItsName) {
    const test::TemporaryFolder folder;
    const Trajectory truth = some_poses();
    write_trajectory(folder / "another_name.txt", truth);
    const Trajectory copy = read_trajectory(folder / "another_name.txt");
    EXPECT_TRUE(is_part_of(copy, truth));
    EXPECT_TRUE(is_part_of(Trajectory(copy.begin() + 5, copy.begin() + 9), truth)) << "some of its lines";
    EXPECT_FALSE(is_part_of(truth, Trajectory(copy.begin() + 5, copy.begin() + 9)));
    EXPECT_FALSE(is_part_of({}, truth));
    EXPECT_FALSE(is_part_of(truth, {}));
    Trajectory moved = copy, turned = copy, later = copy;
    moved[7].world_from_camera.translation().x() += 1e-4;
    turned[7].world_from_camera.rotate(Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitX()));
    later[7].utime += 10;
    for (const Trajectory& other : {moved, turned, later}) EXPECT_FALSE(is_part_of(other, truth));
}

}  // namespace
}  // namespace planemap
