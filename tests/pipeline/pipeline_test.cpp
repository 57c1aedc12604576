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

#include "data_folder.hpp"
#include "decimated_sequence.hpp"
#include "evaluate/evaluation.hpp"
#include "run/input.hpp"
#include "segmentation/outline_reach.hpp"
#include "segmentation/segmentation.hpp"
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

}  // namespace
}  // namespace planemap::pipeline
