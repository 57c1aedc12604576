// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "core/validation.hpp"
#include "sensor/dataset.hpp"
#include "sensor/log_source.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::sensor {

namespace {

using Source = std::unique_ptr<FrameSource>;

bool is_simulator(const std::string& input) {
    return input.starts_with("sim:");
}

bool is_file(const std::string& input) {
    std::error_code ignored;
    return std::filesystem::exists(input, ignored) && !std::filesystem::is_directory(input, ignored);
}

Source open_simulator(const std::string& input, const SourceOptions& options) {
    if (options.camera)
        throw std::invalid_argument(input + ": the simulator has a camera of its own; no --camera");
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(input));
    source->select(options.frames);
    return source;
}

Source open_log(const std::string& input, const SourceOptions& options) {
    return std::make_unique<LogSource>(input, options);
}

Source open_folder(const std::string& input, const SourceOptions& options) {
    return std::make_unique<Dataset>(input, options);
}

/// One row a kind of input. The first that `is` so is opened; the last takes what is left.
struct Opener {
    InputKind kind;
    bool has_channels;  ///< SourceOptions::channel is for it
    bool (*is)(const std::string& input);
    Source (*open)(const std::string& input, const SourceOptions& options);
};
constexpr Opener kOpeners[] = {
    {InputKind::kSimulator, false, is_simulator, open_simulator},
    {InputKind::kLog, true, is_file, open_log},
    {InputKind::kFolder, false, [](const std::string&) { return true; }, open_folder},
};

const Opener& opener_of(const std::string& input) {
    return *std::find_if(std::begin(kOpeners), std::end(kOpeners),
                         [&](const Opener& opener) { return opener.is(input); });
}

}  // namespace

void SourceOptions::validate() const {
    FieldErrors errors("source options");
    errors.require(std::isfinite(max_color_gap_s) && max_color_gap_s >= 0, "max_color_gap_s", max_color_gap_s,
                   "finite and at least 0");
    errors.throw_if_any();
}

InputKind kind_of_input(const std::string& input) {
    return opener_of(input).kind;
}

std::unique_ptr<FrameSource> open_source(const std::string& input, const SourceOptions& options) {
    options.validate();
    const Opener& opener = opener_of(input);
    if (!options.channel.empty() && !opener.has_channels)
        throw std::invalid_argument(input + ": has no channels; --channel is for LCM logs");
    return opener.open(input, options);
}

}  // namespace planemap::sensor
