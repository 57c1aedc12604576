// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "graph/graph.hpp"
#include "messages/process.hpp"

namespace planemap {

/// PLANEMAP_KEYFRAME to PLANEMAP_TRAJECTORY.
class GraphShell : public Shell {
  public:
    GraphShell(Bus& bus, const GraphOptions& options);

    ModuleStatus& status() override { return status_; }
    /// Optimises once more and publishes the result.
    void finish() override;
    const PoseGraph& graph() const { return graph_; }

  private:
    void on_keyframe(const RawMessage& message);
    void publish();

    Bus& bus_;
    PoseGraph graph_;
    ModuleStatus status_{"graph"};
    std::int32_t seq_ = 0;
};

/// Flags for the options, each named --<prefix>NAME.
void add_flags(Flags& flags, GraphOptions& options, const std::string& prefix = "");

}  // namespace planemap
