// SPDX-License-Identifier: BSD-3-Clause
// planemap-calibrate as a user runs it, and what it says of sensors whose bias is known.
#include "calibrate/calibration.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/camera_file.hpp"
#include "core/depth_correction.hpp"
#include "core/offset_at.hpp"
#include "simulator/simulated_source.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

struct CalibrateTest : test::Programs {
    /// What a simulated sensor's readings of a range are off by, RMS over the image, metres; corrected.
    static double off_by(const std::string& world, const DepthCorrection& correction, double range_m) {
        const simulator::SimulatedSource source(simulator::parse_simulator_name(world));
        const PinholeCamera& depth = source.camera().depth;
        double sum = 0;
        int count = 0;
        for (int v = 5; v < depth.height; v += 10) {
            for (int u = 5; u < depth.width; u += 10) {
                const double read = source.bias() ? source.bias()->read(u, v, range_m) : range_m;
                sum += std::pow(read / (1 + read * test::offset_at(correction, depth, u, v)) - range_m, 2);
                ++count;
            }
        }
        return std::sqrt(sum / count);
    }
    DepthCorrection calibrated(const std::string& world) {
        const Outcome outcome =
            run("planemap-calibrate", "'" + world + "' --passes 3 -q --output " + path("camera.json"));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("readings of 3 m"));
        return read_camera_file(path("camera.json")).depth_correction.value();
    }
};

constexpr const char* kRoom = "sim:office?frames=200&rate=10&width=320&height=240";

TEST_F(CalibrateTest, ABentSensorIsMadeStraighter) {
    const std::string bent = std::string(kRoom) + "&bias=0.04";
    const DepthCorrection correction = calibrated(bent);
    EXPECT_GT(off_by(bent, {}, 4), 0.12);
    EXPECT_LT(off_by(bent, correction, 4), 0.5 * off_by(bent, {}, 4));
    const Outcome run_with = run("planemap-run", "'" + bent + "' --no-octomap -q --camera " +
                                                     path("camera.json") + " --output " + path("out"));
    EXPECT_EQ(run_with.exit_code, 0) << run_with.err;
    EXPECT_GT(report("out").at("explained_points").get<double>(), 0.9);
}

TEST_F(CalibrateTest, NothingIsInventedOfAStraightOne) {
    EXPECT_LT(off_by(kRoom, calibrated(kRoom), 3), 0.001);
}

TEST_F(CalibrateTest, BadInputIsOneLineAndWritesNothing) {
    const std::string output = " -q --output " + path("camera.json");
    expect_error("planemap-calibrate", "sim:office --passes 0" + output, "passes");
    expect_error("planemap-calibrate", path("nowhere") + output, "nowhere");
    expect_error("planemap-calibrate", "'sim:office?frames=1&width=80&height=60'" + output,
                 "says nothing of its depth");
    EXPECT_FALSE(std::filesystem::exists(path("camera.json")));
}

}  // namespace
}  // namespace planemap
