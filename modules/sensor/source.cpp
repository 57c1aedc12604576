// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <cmath>

#include "core/validation.hpp"
#include "sensor/dataset.hpp"
#include "sensor/simulator/simulated_source.hpp"

namespace planemap {

void SourceOptions::validate() const {
    FieldErrors errors("source options");
    errors.require(std::isfinite(max_color_gap_s) && max_color_gap_s >= 0, "max_color_gap_s", max_color_gap_s,
                   "finite and at least 0");
    errors.throw_if_any();
}

std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options) {
    options.validate();
    if (input.starts_with("sim:")) {
        auto source = std::make_unique<sim::SimulatedSource>(sim::parse_simulator_name(input));
        source->select(options.frames);
        return source;
    }
    return std::make_unique<Dataset>(input, options);
}

}  // namespace planemap
