// SPDX-License-Identifier: BSD-3-Clause
#include "run/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/time_step.hpp"
#include "odometry/odometry_shell.hpp"
#include "run/report_text.hpp"
#include "run/worth.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

/// Hands move by a tenth of the view and more in this time: features leave the search of the flow, and depth
/// steps leave the surface that the frame is laid on.
constexpr double kSlowStep_s = 0.2;
constexpr double kScaleOff = 0.02;
/// A path this many times as wide as its poses err tells its scale; of a smaller one the scale is noise.
constexpr double kWide = 5;
constexpr double kOther = 1.5;  // times: no odometry drifts so

double median_step_s(const std::vector<OdometryEstimate>& estimates) {
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < estimates.size(); ++i)
        steps.push_back(estimates[i].utime - estimates[i - 1].utime);
    return steps.empty() ? 0 : 1e-6 * static_cast<double>(median_step(steps));
}

/// Where depth is off by more than it scatters, and than that is uncertain, the map is as bent; empty if not.
std::string bent_depth(const Json& report) {
    const Json depth = report.value("depth_off", Json());
    if (!depth.is_object()) return "";
    const auto metres = [&](const char* key) { return depth.at(key).get<double>(); };
    if (!(metres("off_m") > metres("noise_m") && metres("off_m") > metres("sigma_m"))) return "";
    return format("surfaces fit together best if depth readings of %g m", metres("range_m")) +
           format(" are off by %.1f cm", 100 * metres("off_m")) +
           format(" (over the image; certain to %.1f cm)", 100 * metres("sigma_m")) +
           ": planemap-calibrate learns how, and --camera with its file corrects it";
}

/// A line for each kind of image that was left out, since it says nothing of its moment.
std::vector<std::string> old_images(const Json& report) {
    std::vector<std::string> lines;
    const Json losses = report.value("losses", Json::object()).value("odometry", Json::object());
    using Shell = odometry::OdometryShell;
    for (const char* reason : {Shell::kColorRepeats, Shell::kColorLate, Shell::kDepthRepeats})
        if (losses.contains(reason)) lines.push_back(losses.at(reason).dump() + " " + reason);
    return lines;
}

}  // namespace

std::vector<std::string> warnings_of(const std::vector<OdometryEstimate>& estimates, bool poses_given,
                                     const std::optional<std::string>& reason_lost, const Json& report) {
    std::vector<std::string> warnings;
    const std::optional<RunWorth> worth = worth_of(report);
    if (worth && worth->tracked > 0 && worth->tracked_few()) {  // of none there is an error
        warnings.push_back("only " + std::to_string(worth->tracked) + " of " + std::to_string(worth->frames) +
                           " frames are tracked: the map is of what these saw" +
                           (reason_lost ? "; why not the others: " + *reason_lost : ""));
    }
    const double step_s = median_step_s(estimates);
    if (step_s > kSlowStep_s && !poses_given) {
        warnings.push_back(
            format("frames are %.2g s apart (median)", step_s) +
            format("; tracking is made for %g s and less: poses and scale may be off where the "
                   "camera moved far between two",
                   kSlowStep_s));
    }
    for (std::string& line : old_images(report)) warnings.push_back(std::move(line));
    const std::string bent = bent_depth(report);
    if (!bent.empty()) warnings.push_back(bent);
    if (!report.contains("accuracy")) return warnings;
    const Json& accuracy = report.at("accuracy");
    const Json scale = accuracy.value("scale", Json());
    if (!scale.is_number()) return warnings;
    const double ate_m = accuracy.value("ate_rmse_m", 0.0);
    const Json scaled_m = accuracy.value("ate_scaled_rmse_m", Json());
    // Of a path that errs by more than its size the scale is noise, unless it is the scale that errs.
    const bool is_other = std::abs(std::log(scale.get<double>())) > std::log(kOther) &&
                          scaled_m.is_number() && scaled_m.get<double>() < 0.5 * ate_m;
    if (!is_other && accuracy.value("extent_m", 0.0) < kWide * ate_m) return warnings;
    const double too_long = 1 / scale.get<double>() - 1;
    if (std::abs(scale.get<double>() - 1) > kScaleOff) {
        warnings.push_back(format("the trajectory is %.1f %% ", 100 * std::abs(too_long)) +
                           (too_long > 0 ? "too long" : "too short") +
                           format(" against the truth (scale %.3f)", scale.get<double>()) +
                           (is_other && !poses_given
                                ? ": are depth_units_per_metre and the focal lengths in camera.json right?"
                                : ""));
    }
    return warnings;
}

}  // namespace planemap
