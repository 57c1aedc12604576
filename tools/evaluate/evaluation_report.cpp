// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/evaluation_report.hpp"

namespace planemap::evaluation {

namespace {

using results::Json;
using results::known;

Json statistics_figures(const Statistics& s) {
    return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median},
            {"std", s.std},   {"min", s.min},   {"max", s.max}};
}

Json rmse_m(const std::optional<RelativeError>& error) {
    return known(error, [](const RelativeError& found) { return found.metres.rmse; });
}

Json rmse_deg(const std::optional<RelativeError>& error) {
    return known(error, [](const RelativeError& found) { return found.degrees.rmse; });
}

}  // namespace

Json relative_figures(const std::optional<RelativeError>& error) {
    if (!error) return nullptr;
    return {{"pairs", error->metres.count},
            {"left_out", error->left_out},
            {"trans", statistics_figures(error->metres)},
            {"rot_deg", statistics_figures(error->degrees)}};
}

Json all_figures(const Evaluation& evaluation) {
    Json json = {{"truth_poses", evaluation.truth_poses},
                 {"estimate_poses", evaluation.estimate_poses},
                 {"pairs", evaluation.pairs},
                 {"matched_share", evaluation.matched_share},
                 {"path_length_m", evaluation.path_length_m},
                 {"scale", evaluation.ate->scale},
                 {"ate", statistics_figures(evaluation.ate->metres)},
                 {"rpe_frame", relative_figures(evaluation.rpe_frame)},
                 {"rpe_1s", relative_figures(evaluation.rpe_1s)}};
    if (!evaluation.rpe_frame) json["rpe_frame_why"] = evaluation.why_no_rpe_frame;
    if (!evaluation.rpe_1s) json["rpe_1s_why"] = evaluation.why_no_rpe_1s;
    return json;
}

Json accuracy_figures(const Evaluation& evaluation) {
    Json json = {{"ate_rmse_m", evaluation.ate->metres.rmse},
                 {"rpe_frame_rmse_m", rmse_m(evaluation.rpe_frame)},
                 {"rpe_frame_rmse_deg", rmse_deg(evaluation.rpe_frame)},
                 {"scale", evaluation.ate->scale},
                 {"pairs", evaluation.pairs},
                 {"path_length_m", evaluation.path_length_m},
                 {"extent_m", evaluation.extent_m}};
    if (!evaluation.rpe_frame) json["rpe_frame_why"] = evaluation.why_no_rpe_frame;
    return json;
}

Json row_figures(const std::optional<Evaluation>& evaluation) {
    const Evaluation e = evaluation.value_or(Evaluation());
    return {{"path_m", known(evaluation, [](const Evaluation& all) { return all.path_length_m; })},
            {"ate_m", known(e.ate, [](const AbsoluteError& error) { return error.metres.rmse; })},
            {"rpe_frame_m", rmse_m(e.rpe_frame)},
            {"rpe_frame_deg", rmse_deg(e.rpe_frame)},
            {"rpe_1s_m", rmse_m(e.rpe_1s)},
            {"rpe_1s_deg", rmse_deg(e.rpe_1s)},
            {"scale", known(e.ate, [](const AbsoluteError& error) { return results::number(error.scale); })}};
}

}  // namespace planemap::evaluation
