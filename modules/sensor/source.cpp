// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/validation.hpp"
#include "sensor/dataset.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::sensor {

namespace {

/// What a file is that stands where a folder should, and what to do with it.
std::string about_file(const std::filesystem::path& file) {
    char start[4] = {};
    std::ifstream(file, std::ios::binary).read(start, sizeof(start));
    if (std::string_view(start, sizeof(start)) == "\xed\xa1\xda\x01") {
        return "not a folder but an LCM log; `planemap-run " + file.string() +
               " --output DIR` maps it, `lcm-logplayer " + file.string() +
               "` replays it to modules that run without a sensor";
    }
    const std::string name = file.filename().string();
    for (const char* list : {"depth.txt", "rgb.txt", "associations.txt", "camera.json"}) {
        if (name == list) return "not a folder; give the folder that it lies in";
    }
    return "not a folder; give one with rgb.txt, depth.txt and camera.json, or sim:WORLD";
}

}  // namespace

void SourceOptions::validate() const {
    FieldErrors errors("source options");
    errors.require(std::isfinite(max_color_gap_s) && max_color_gap_s >= 0, "max_color_gap_s", max_color_gap_s,
                   "finite and at least 0");
    errors.throw_if_any();
}

std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options) {
    options.validate();
    if (input.starts_with("sim:")) {
        auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(input));
        source->select(options.frames);
        return source;
    }
    std::error_code ignored;
    if (std::filesystem::is_regular_file(input, ignored)) {
        throw std::runtime_error(input + ": " + about_file(input));
    }
    return std::make_unique<Dataset>(input, options);
}

}  // namespace planemap::sensor
