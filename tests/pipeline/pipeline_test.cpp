// SPDX-License-Identifier: BSD-3-Clause
// Whole recordings through all modules in this process: depth and colour of different resolutions.
#include "pipeline/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <random>

#include "core/geometry/plane.hpp"
#include "data_folder.hpp"
#include "decimated_sequence.hpp"
#include "evaluate/evaluation.hpp"
#include "map/observation.hpp"
#include "map/rules.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "run/input.hpp"
#include "segmentation/outline_reach.hpp"
#include "segmentation/segmentation.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::pipeline {
namespace {

struct Outcome {
    long frames = 0, tracked = 0;
    int closures = 0;
    double ate_m = -1;  ///< -1: no truth
};

Outcome run(const std::filesystem::path& recording) {
    messages::Bus bus("memq://");
    PipelineOptions options;
    options.with_octomap = false;
    Pipeline pipeline(bus, options);
    const std::unique_ptr<Input> input = open_input(recording.string(), bus);
    while (input->feed()) pipeline.settle();
    pipeline.finish();
    Outcome outcome;
    outcome.frames = static_cast<long>(input->frames());
    outcome.tracked = std::count_if(pipeline.estimates().begin(), pipeline.estimates().end(),
                                    [](const auto& e) { return e.status != TrackingStatus::kLost; });
    outcome.closures = static_cast<int>(pipeline.keyframes().loop_closures);
    if (const std::optional<Trajectory> truth = input->truth()) {
        const Evaluation evaluation = evaluate(*truth, pipeline.trajectory(), {});
        if (evaluation.ate) outcome.ate_m = evaluation.ate->metres.rmse;
    }
    std::printf("%s: %ld of %ld tracked, %d closures, ATE %.4f m\n", recording.filename().c_str(),
                outcome.tracked, outcome.frames, outcome.closures, outcome.ate_m);
    return outcome;
}

class Resolutions : public testing::Test {
  protected:
    Outcome run_decimated(const std::string& sequence, double factor, bool registered) {
        const std::filesystem::path to =
            folder_ / (sequence + "_" + std::to_string(factor) + (registered ? "_registered" : ""));
        test::write_decimated(test::data_folder(sequence), to, factor, registered);
        return run(to);
    }
    test::TemporaryFolder folder_;
};

TEST_F(Resolutions, CoarserDepthIsTracked) {
    PLANEMAP_NEEDS_DATA("fr3_cabinet");
    for (const double factor : {1.25, 1.4, 1.5, 2.0})
        EXPECT_GE(run_decimated("fr3_cabinet", factor, false).tracked, 55) << factor;
    EXPECT_GE(run_decimated("fr3_cabinet", 1.4, true).tracked, 55) << "registered, of another size";
}

TEST_F(Resolutions, HalfSizeRegisteredDepthIsNearlyAsGood) {
    PLANEMAP_NEEDS_DATA("fr1_rpy_start");
    const Outcome full = run(test::data_folder("fr1_rpy_start"));
    const Outcome half = run_decimated("fr1_rpy_start", 2, true);
    EXPECT_EQ(half.tracked, full.tracked);
    EXPECT_LE(half.ate_m, 1.2 * full.ate_m);
    EXPECT_GE(half.closures, 1);
}

TEST_F(Resolutions, AWideDepthCameraBesideANarrowColourCameraIsTracked) {
    PLANEMAP_NEEDS_DATA("aims_robot");
    const Outcome outcome = run(test::data_folder("aims_robot"));
    EXPECT_EQ(outcome.frames, 80);
    EXPECT_GE(outcome.tracked, 79);
}

/// Real sensors' noise, ranges and gaps.
TEST(OutlinesOfRecordings, DoNotReachBeyondReadings) {
    const std::unique_ptr<segmentation::Segmenter> segmenter = segmentation::make_segmenter({});
    int looked_at = 0;
    for (const char* sequence : {"aims_robot", "d435_stills"}) {
        if (!std::filesystem::is_directory(test::data_folder(sequence))) continue;
        sensor::Dataset dataset(test::data_folder(sequence));
        SensorFrame frame;
        for (int i = 0; dataset.next(frame).status == ReadResult::Status::kFrame; ++i) {
            if (i % 8 != 0) continue;
            segmentation::Segmentation segmentation;
            segmenter->segment(frame.depth, dataset.camera(), segmentation);
            const segmentation::Reach reach =
                segmentation::reach_of(segmentation, frame.depth, dataset.camera());
            EXPECT_LE(reach.worst, 1) << sequence << ", frame " << i;
            EXPECT_EQ(reach.crossing, 0) << sequence << ", frame " << i;
            ++looked_at;
        }
    }
    if (looked_at == 0)
        GTEST_SKIP() << "sample data aims_robot and d435_stills are missing (set PLANEMAP_DATA)";
}

/// Frames of one depth image without colour, as a recording.
std::string why_none_tracked(const std::filesystem::path& folder, const CameraInfo& camera,
                             const std::function<std::uint16_t(int, int)>& reading) {
    std::filesystem::create_directories(folder / "depth");
    std::string list;
    for (int i = 0; i < 3; ++i) {
        DepthImage depth(camera.depth.width, camera.depth.height);
        for (int v = 0; v < depth.height; ++v) {
            for (int u = 0; u < depth.width; ++u) depth(u, v) = reading(u, v);
        }
        const std::string name = "depth/" + std::to_string(i) + ".png";
        sensor::write_depth_png(folder / name, depth);
        list += std::to_string(1 + 0.1 * i) + " " + name + "\n";
    }
    write_file(folder / "depth.txt", list);
    write_file(folder / "camera.json",
               R"({"depth_camera": {"width": 160, "height": 120, "fx": 140, "fy": 140, "cx": 80, "cy": 60},)"
               R"( "depth_units_per_metre": 1000})");
    messages::Bus bus("memq://");
    PipelineOptions options;
    options.with_octomap = false;
    Pipeline pipeline(bus, options);
    const std::unique_ptr<Input> input = open_input(folder.string(), bus);
    while (input->feed()) pipeline.settle();
    pipeline.finish();
    EXPECT_EQ(pipeline.estimates().size(), 3u);
    for (const OdometryEstimate& estimate : pipeline.estimates())
        EXPECT_EQ(estimate.status, TrackingStatus::kLost);
    return pipeline.why_lost();
}

TEST(WhyLost, DepthIsBlamedOnlyForItsOwnFaults) {
    const test::TemporaryFolder folder;
    CameraInfo camera;
    camera.depth = {160, 120, 140, 140, 80, 60};
    EXPECT_NE(why_none_tracked(folder / "far", camera, [](int, int) { return std::uint16_t{30000}; })
                  .find("hardly a depth reading"),
              std::string::npos);
    std::mt19937 random(1);
    const auto anything = [&](int, int) { return static_cast<std::uint16_t>(500 + random() % 6000); };
    EXPECT_NE(why_none_tracked(folder / "noise", camera, anything).find("nothing to follow"),
              std::string::npos);
}

/// What a walk through a simulated room gave, with the camera's poses known.
struct WeighedMap {
    PlaneMap map;
    std::vector<Keyframe> keyframes;

    /// What the map counts a region for, the mean over those of the first keyframe.
    double mean_weight() const {
        const planemap::map::ObservationModel model = planemap::map::observation_model({});
        const planemap::map::StoredKeyframe first = planemap::map::stored(0, keyframes.at(0).regions);
        double sum = 0;
        for (const auto& region : first.regions) sum += model.weight(region, keyframes[0].noise);
        return sum / static_cast<double>(first.regions.size());
    }
};

/// A simulated camera that is said to have so many times the noise that it has.
class SaidNoise : public FrameSource {
  public:
    SaidNoise(const std::string& name, double factor)
        : source_(simulator::parse_simulator_name(name)), camera_(source_.camera()) {
        camera_.noise.base_m *= factor;
        camera_.noise.quadratic_per_m *= factor;
    }
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return source_.size(); }
    ReadResult next(SensorFrame& frame) override { return source_.next(frame); }

  private:
    simulator::SimulatedSource source_;
    CameraInfo camera_;
};

/// The same frames, by a camera that is said to have this many times the noise.
WeighedMap weighed_map(double noise) {
    const std::string name = "sim:office?frames=30&rate=10&width=320&height=240";
    const simulator::SimulatedSource source(simulator::parse_simulator_name(name));
    messages::Bus bus("memq://");
    PipelineOptions options;
    options.with_octomap = false;
    options.poses.emplace();
    for (std::size_t i = 0; i < 30; ++i)
        options.poses->push_back({source.utime(i), source.world_from_color(source.utime(i))});
    Pipeline pipeline(bus, options);
    WeighedMap result;
    bus.subscribe(messages::channels::kKeyframe, [&](const messages::RawMessage& message) {
        result.keyframes.push_back(messages::from_message(messages::decode<keyframe_t>(message.bytes)));
    });
    sensor::SensorShellOptions pace;
    pace.speed = 0;
    sensor::SensorShell sensor(bus, std::make_unique<SaidNoise>(name, noise), pace);
    while (sensor.poll() >= 0) pipeline.settle();
    pipeline.finish();
    result.map = pipeline.map().mapper().map();
    return result;
}

/// The noise that a camera is said to have goes from its description to what the map counts its regions for.
TEST(SensorNoise, TwiceAsMuchChangesTheMapsWeights) {
    const WeighedMap once = weighed_map(1), twice = weighed_map(2);
    ASSERT_FALSE(once.keyframes.empty());
    ASSERT_FALSE(twice.keyframes.empty());
    ASSERT_FALSE(once.map.planes.empty());
    ASSERT_FALSE(twice.map.planes.empty());
    EXPECT_DOUBLE_EQ(twice.keyframes[0].noise.sigma(3), 2 * once.keyframes[0].noise.sigma(3));
    EXPECT_LT(twice.mean_weight(), 0.95 * once.mean_weight());
    EXPECT_GT(twice.mean_weight(), 0.25 * once.mean_weight()) << "poses err, too, and as before";
    // Other weights, other planes: the floor of both is one, and not the same to the last digit.
    const auto largest = [](const PlaneMap& map) {
        return std::max_element(map.planes.begin(), map.planes.end(),
                                [](const MapPlane& a, const MapPlane& b) { return a.area < b.area; })
            ->plane();
    };
    const Plane a = largest(once.map), b = largest(twice.map);
    EXPECT_LT(angle_between(a.normal, b.normal), 0.02);
    EXPECT_NEAR(a.d, b.d, 0.02);
    EXPECT_NE(a.d, b.d);
}

}  // namespace
}  // namespace planemap::pipeline
