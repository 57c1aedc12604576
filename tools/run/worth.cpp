// SPDX-License-Identifier: BSD-3-Clause
#include "run/worth.hpp"

#include <exception>
#include <nlohmann/json.hpp>

#include "core/files.hpp"

namespace planemap {

using Json = nlohmann::ordered_json;

std::optional<RunWorth> worth_of(const Json& report) {
    try {
        return RunWorth{report.at("frames").get<std::int64_t>(), report.at("tracked").get<std::int64_t>(),
                        report.value("interrupted", false)};
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::optional<RunWorth> worth_in(const std::filesystem::path& folder) {
    try {
        return worth_of(Json::parse(read_file(folder / "report.json")));
    } catch (const std::exception&) {
        return std::nullopt;  // no report: what the results there are worth is not known
    }
}

std::string why_not_replace(const RunWorth& run, const std::optional<RunWorth>& earlier) {
    if (run.is_sound()) return {};
    if (earlier && !earlier->is_sound() && run.tracked >= earlier->tracked) return {};
    const std::string frames = std::to_string(run.frames) + (run.frames == 1 ? " frame" : " frames");
    if (run.interrupted)
        return "ended before the end of its input, " + std::to_string(run.tracked) + " of " + frames +
               " tracked";
    if (run.tracked == 0) return "none of its " + frames + " tracked";
    return "only " + std::to_string(run.tracked) + " of its " + frames + " tracked";
}

}  // namespace planemap
