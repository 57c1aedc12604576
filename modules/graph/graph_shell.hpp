// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <optional>

#include "graph/graph.hpp"
#include "messages/channels.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"

namespace planemap::graph {

/// Where the graph is optimised.
enum class Optimising {
    kInHandler,     ///< before the keyframe's trajectory is published: the same input gives the same output
    kInBackground,  ///< on another thread; messages do not wait, and the result is published when it is there
};

/// PLANEMAP_KEYFRAME to PLANEMAP_TRAJECTORY.
class GraphShell : public messages::Shell {
  public:
    GraphShell(messages::Bus& bus, const GraphOptions& options,
               Optimising optimising = Optimising::kInHandler);

    messages::ModuleStatus& status() override { return status_; }
    /// Publishes what the background has finished, gives it what is due, and repeats the trajectory when a
    /// second has passed without one.
    int poll() override;
    /// Waits for the background, optimises once more and publishes the result.
    void finish() override;
    const PoseGraph& graph() const { return graph_; }

  private:
    void on_keyframe(const messages::RawMessage& message);
    void refuse(int id);
    void start_if_due();
    void publish();
    void tell_losses();
    void republish_if_due();

    messages::Bus& bus_;
    Optimising optimising_;
    PoseGraph graph_;
    std::optional<GraphOptimisation> running_;  ///< owned by the background until done_ is ready
    std::future<void> done_;
    messages::ModuleStatus status_{"graph"};
    messages::StreamGuard keyframe_guard_{messages::channels::kKeyframe, "keyframes", status_};
    GraphCounts told_;  ///< to the status
    std::int32_t seq_ = 0;
    std::int64_t published_us_ = 0;    ///< wall clock of the last trajectory; 0: none yet
    std::optional<int> last_refused_;  ///< id of the last keyframe that was left out
    int refused_in_row_ = 0;           ///< with ids one after the other
    bool odometry_started_again_ = false;
};

}  // namespace planemap::graph
