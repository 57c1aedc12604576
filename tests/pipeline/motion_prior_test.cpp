// SPDX-License-Identifier: BSD-3-Clause
// The simulator's walk along a wall of bare paint, with and without its robot's word, as it comes on the bus.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "odometry/odometry_shell.hpp"
#include "segmentation/segmentation_shell.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap {
namespace {

constexpr const char* kWheels = "WHEELS";

struct Walk {
    int frames = 0, degenerate = 0;
    double off_m = 0;  ///< of poses, root mean square, the first one being true
    std::map<std::string, std::int64_t> losses;
    std::vector<Pose> poses;
};

/// `factor` is on the ways that the wheels say; 0: they say nothing.
Walk walk(double factor) {
    const simulator::SimulatorOptions world =
        simulator::parse_simulator_name("sim:wall?rate=10&width=320&height=240&frames=200&mounted=1");
    const simulator::SimulatedSource truth(world);
    odometry::OdometryOptions options;
    if (factor != 0) options.motion.channel = kWheels;
    messages::Bus bus("memq://");
    const auto decoder = std::make_shared<messages::FrameDecoder>(bus);
    segmentation::SegmentationShell segmentation(bus, decoder, {});
    odometry::OdometryShell odometry(bus, decoder, options);
    Walk walk;
    double squares = 0;
    bus.subscribe(messages::channels::kOdometry, [&](const messages::RawMessage& message) {
        const auto estimate = messages::from_message(messages::decode<odometry_t>(message.bytes));
        ++walk.frames;
        walk.degenerate += estimate.status == TrackingStatus::kDegenerate ? 1 : 0;
        const Pose moved =
            truth.world_from_color(truth.utime(0)).inverse() * truth.world_from_color(estimate.pose_utime);
        squares += (moved.translation() - estimate.odom_from_camera.translation()).squaredNorm();
        walk.poses.push_back(estimate.odom_from_camera);
    });
    const Trajectory motion = truth.body_motion();
    sensor::SensorShellOptions pace;
    pace.speed = 0;
    sensor::SensorShell sensor(bus, std::make_unique<simulator::SimulatedSource>(world), pace);
    std::size_t told = 0;
    while (sensor.poll() >= 0) {
        for (; told < motion.size() && motion[told].utime <= sensor.last_utime(); ++told) {
            BodyMotion body;
            body.local_from_body = motion[told].world_from_camera;
            body.local_from_body.translation() *= factor;
            bus.publish(kWheels, messages::to_message(body, motion[told].utime));
        }
        bus.drain();
    }
    odometry.finish();
    bus.drain();
    walk.off_m = std::sqrt(squares / walk.frames);
    walk.losses = odometry.status().losses();
    std::printf("factor %.1f: %d frames, %d degenerate, off by %.3f m\n", factor, walk.frames,
                walk.degenerate, walk.off_m);
    for (const auto& [what, count] : walk.losses)
        std::printf("  %lld %s\n", static_cast<long long>(count), what.c_str());
    return walk;
}

TEST(MotionPrior, OfWheelsIsFollowedAlongABareWallAndOneThatLiesChangesNothing) {
    const Walk without = walk(0), with = walk(1), lying = walk(3);
    ASSERT_GT(without.degenerate, 5) << "the wall is bare";
    EXPECT_LT(with.off_m, 0.9 * without.off_m);
    EXPECT_EQ(with.losses.count(odometry::OdometryShell::kPriorContradicts), 0u);
    EXPECT_GT(lying.losses.at(odometry::OdometryShell::kPriorContradicts), 100);
    ASSERT_EQ(lying.poses.size(), without.poses.size());
    for (std::size_t i = 0; i < lying.poses.size(); ++i)
        ASSERT_EQ(lying.poses[i].matrix(), without.poses[i].matrix()) << i;
}

}  // namespace
}  // namespace planemap
