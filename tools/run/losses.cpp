// SPDX-License-Identifier: BSD-3-Clause
#include "run/losses.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "pipeline/pipeline.hpp"

namespace planemap {

namespace {
using Json = nlohmann::ordered_json;

std::vector<const messages::ModuleStatus*> statuses_of(pipeline::Pipeline& pipeline) {
    std::vector<const messages::ModuleStatus*> statuses{&pipeline.segmentation().status(),
                                                        &pipeline.odometry().status()};
    if (pipeline.graph() != nullptr) statuses.push_back(&pipeline.graph()->status());
    statuses.push_back(&pipeline.map().status());
    if (pipeline.octomap() != nullptr) statuses.push_back(&pipeline.octomap()->status());
    return statuses;
}

}  // namespace

std::vector<std::string> remarks_of(pipeline::Pipeline& pipeline) {
    std::vector<std::string> remarks;
    for (const messages::ModuleStatus* status : statuses_of(pipeline)) {
        for (const std::string& remark : status->remarks())
            if (std::find(remarks.begin(), remarks.end(), remark) == remarks.end()) remarks.push_back(remark);
    }
    return remarks;
}

Json losses_of(pipeline::Pipeline& pipeline) {
    Json losses = Json::object();
    for (const messages::ModuleStatus* status : statuses_of(pipeline)) {
        Json module = Json::object();
        for (const auto& [what, count] : status->losses()) module[what] = count;
        if (status->decode_error_count() > 0)
            module["messages that were corrupt"] = status->decode_error_count();
        if (!module.empty()) losses[status->module()] = std::move(module);
    }
    return losses;
}

std::string losses_markdown(const Json& report) {
    if (!report.contains("losses") || report.at("losses").empty()) return {};
    // Two modules that lose the same frames are one line.
    std::vector<std::pair<std::string, std::string>> lines;  // what, modules
    for (const auto& [module, reasons] : report.at("losses").items()) {
        for (const auto& [what, count] : reasons.items()) {
            const std::string text = std::to_string(count.get<std::int64_t>()) + " " + what;
            const auto line =
                std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.first == text; });
            if (line == lines.end())
                lines.emplace_back(text, module);
            else
                line->second += ", " + module;
        }
    }
    std::string out = "Not used:\n";
    for (const auto& [what, modules] : lines) out += "- " + what + " (" + modules + ")\n";
    return out + "\n";
}

}  // namespace planemap
