// SPDX-License-Identifier: BSD-3-Clause
// Whole recordings through all modules in this process: depth and colour of different resolutions.
#include "run/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "core/temporary_folder.hpp"
#include "data_folder.hpp"
#include "decimated_sequence.hpp"
#include "evaluate/evaluation.hpp"
#include "run/input.hpp"

namespace planemap {
namespace {

struct Outcome {
    long frames = 0, tracked = 0;
    int closures = 0;
    double ate_m = -1;  ///< -1: no truth
};

Outcome run(const std::filesystem::path& recording) {
    Bus bus("memq://");
    PipelineOptions options;
    options.with_octomap = false;
    Pipeline pipeline(bus, options);
    const std::unique_ptr<Input> input = open_input(recording.string(), bus, std::nullopt);
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

}  // namespace
}  // namespace planemap
