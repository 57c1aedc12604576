// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace planemap {

namespace pipeline {
class Pipeline;
}

/// What each module of a run did not use: module -> reason -> count, messages that were corrupt among them.
/// Modules that lost nothing are left out.
nlohmann::ordered_json losses_of(pipeline::Pipeline& pipeline);

/// What the modules remarked (ModuleStatus::remark()), each once.
std::vector<std::string> remarks_of(pipeline::Pipeline& pipeline);

/// What was lost in lines for report.md, a reason a line with its modules; empty when there are none, or when
/// the report is from before they were told. Throws nlohmann::json::exception for a report that is none.
std::string losses_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
