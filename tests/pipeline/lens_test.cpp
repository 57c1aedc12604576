// SPDX-License-Identifier: BSD-3-Clause
// A walk through a lens that camera.json says, and does not say: from its frames on the bus to poses and
// planes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/geometry/plane.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "odometry/odometry_shell.hpp"
#include "segmentation/segmentation_shell.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap {
namespace {

/// What became of a walk.
struct Walk {
    int frames = 0, tracked = 0;
    double off_m = 0;        ///< of poses, root mean square, the first one being true
    double wrong_share = 0;  ///< of the regions' readings, in regions further than 4 cm or 3 deg from each
                             ///< true plane
};

class WalkTest : public testing::Test {
  protected:
    static Walk walk(const std::string& parameters) {
        const std::string name = "sim:office?frames=60&rate=10&width=320&height=240" + parameters;
        const simulator::SimulatedSource truth(simulator::parse_simulator_name(name));
        messages::Bus bus("memq://");
        const auto decoder = std::make_shared<messages::FrameDecoder>(bus);
        segmentation::SegmentationShell segmentation(bus, decoder, {});
        odometry::OdometryShell odometry(bus, decoder, {});
        Walk walk;
        double squares = 0, readings = 0, wrong = 0;
        bus.subscribe(messages::channels::kOdometry, [&](const messages::RawMessage& message) {
            const auto estimate = messages::from_message(messages::decode<odometry_t>(message.bytes));
            ++walk.frames;
            if (!is_tracked(estimate.status)) return;
            ++walk.tracked;
            const Pose moved = truth.world_from_color(truth.utime(0)).inverse() *
                               truth.world_from_color(estimate.pose_utime);
            squares += (moved.translation() - estimate.odom_from_camera.translation()).squaredNorm();
        });
        bus.subscribe(messages::channels::kRegions, [&](const messages::RawMessage& message) {
            const auto seen = messages::from_message(messages::decode<planar_regions_t>(message.bytes));
            const Pose world_from_camera = truth.world_from_color(seen.utime);
            for (const PlanarRegion& region : seen.regions) {
                readings += region.moments.count;
                if (!is_true(truth.world(), world_from_camera, region)) wrong += region.moments.count;
            }
        });
        sensor::SensorShellOptions pace;
        pace.speed = 0;
        sensor::SensorShell sensor(
            bus, std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(name)), pace);
        while (sensor.poll() >= 0) bus.drain();
        odometry.finish();
        bus.drain();
        walk.off_m = std::sqrt(squares / std::max(walk.tracked, 1));
        walk.wrong_share = wrong / readings;
        std::printf("%s: %d of %d tracked, off by %.4f m, %.1f %% of the readings in wrong planes\n",
                    parameters.c_str(), walk.tracked, walk.frames, walk.off_m, 100 * walk.wrong_share);
        return walk;
    }

  private:
    static bool is_true(const simulator::World& world, const Pose& world_from_camera,
                        const PlanarRegion& region) {
        const Eigen::Vector3d normal = world_from_camera.linear() * region.plane.normal,
                              mean = world_from_camera * region.moments.mean();
        return std::any_of(world.surfaces.begin(), world.surfaces.end(), [&](const auto& surface) {
            return angle_between(surface.plane.normal, normal) < 0.05 &&
                   std::abs(surface.plane.signed_distance(mean)) < 0.04;
        });
    }
};

/// 20 pixels at the corners of 320 x 240, and more.
TEST_F(WalkTest, ThroughALensThatIsSaidIsAsThroughNone) {
    const Walk exact = walk("");
    ASSERT_EQ(exact.tracked, 60);
    for (const std::string lens : {"brown:-0.25,0.06,0.001,-0.002", "fisheye:0,0,0,0"}) {
        const Walk told = walk("&lens=" + lens), untold = walk("&lens_told=0&lens=" + lens);
        EXPECT_EQ(told.tracked, exact.tracked) << lens;
        EXPECT_LT(told.off_m, 1.5 * exact.off_m + 0.005) << lens;
        EXPECT_LT(told.wrong_share, exact.wrong_share + 0.02) << lens;
        EXPECT_GT(untold.off_m, 2 * told.off_m) << lens;
        EXPECT_GT(untold.wrong_share, told.wrong_share + 0.05) << lens;
    }
}

}  // namespace
}  // namespace planemap
