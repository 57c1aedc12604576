// SPDX-License-Identifier: BSD-3-Clause
#include "run/interim.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "messages/module_status.hpp"
#include "pipeline/pipeline.hpp"
#include "run/outputs.hpp"

namespace planemap {

namespace {

constexpr std::chrono::seconds kPeriod{3};
constexpr int kTimesTheCost = 50;

}  // namespace

InterimResults::InterimResults(ResultFolder& folder) : folder_(folder), due_(Clock::now() + kPeriod) {}

void InterimResults::write_if_due(pipeline::Pipeline& pipeline) {
    const Clock::time_point start = Clock::now();
    if (start < due_ || tracked_frames(pipeline) == 0) return;
    const double cpu_start = messages::thread_cpu_ms();
    try {
        for (const Result& result : essential_results(pipeline)) folder_.make(result);
        ++times_;
    } catch (const std::exception& error) {
        if (!failed_) spdlog::warn("what is mapped so far cannot be kept: {}; still trying", error.what());
        failed_ = true;
    }
    for (const std::string& note : folder_.take_notes()) spdlog::warn("{}", note);
    const Clock::duration cost = Clock::now() - start;
    cpu_ms_ += messages::thread_cpu_ms() - cpu_start;
    wall_ms_ += std::chrono::duration<double, std::milli>(cost).count();
    due_ = Clock::now() + std::max<Clock::duration>(kPeriod, kTimesTheCost * cost);
}

}  // namespace planemap
