// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/rounds.hpp"

#include <cmath>
#include <stdexcept>

#include "simulator/simulated_source.hpp"

namespace planemap::benchmark {

std::int64_t frames_a_round(const std::string& simulator_name) {
    const simulator::SimulatorOptions options = simulator::parse_simulator_name(simulator_name);
    if (options.visits > 0 || !options.trajectory.empty())
        throw std::invalid_argument(simulator_name + ": must be a walk that goes round");
    const simulator::SimulatedSource source(options);
    return std::lround(simulator::tour_duration(source.world().tour, source.hand(), options.seed) *
                       options.rate_hz);
}

}  // namespace planemap::benchmark
