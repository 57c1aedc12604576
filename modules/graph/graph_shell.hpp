// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <planemap/keyframe_t.hpp>
#include <set>

#include "core/frame_poses.hpp"
#include "graph/graph.hpp"
#include "graph/graph_journal.hpp"
#include "messages/channels.hpp"
#include "messages/keyframe_guard.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"

namespace planemap::graph {

/// Where the graph is optimised.
enum class Optimising {
    kInHandler,     ///< before the keyframe's trajectory is published: the same input gives the same output
    kInBackground,  ///< on another thread; messages do not wait, and the result is published when it is there
};

/// Where a graph is kept; empty: nowhere.
struct GraphFiles {
    std::filesystem::path
        output;  ///< folder that trajectory.txt, and trajectory_2.txt ... of further components, go to
    std::filesystem::path journal;  ///< keyframes, for a process that is started again
};

/// PLANEMAP_KEYFRAME to PLANEMAP_TRAJECTORY. With a journal, a process that is started again goes on with the
/// keyframes of the one before, in the same world frame. With an output folder, PLANEMAP_ODOMETRY is heard,
/// too, and trajectory.txt has all frames (of those before a restart: the keyframes).
class GraphShell : public messages::Shell {
  public:
    GraphShell(messages::Bus& bus, const GraphOptions& options,
               Optimising optimising = Optimising::kInHandler, const GraphFiles& files = {});

    messages::ModuleStatus& status() override { return status_; }
    /// Publishes what the background has finished, gives it what is due, and repeats the trajectory when a
    /// second has passed without one.
    int poll() override;
    /// Waits for the background, optimises once more and publishes the result.
    void finish() override;
    const PoseGraph& graph() const { return graph_; }
    /// Whether the map's surfaces changed what the graph holds for landmarks since it was last optimised.
    bool has_new_surfaces() const { return has_new_surfaces_; }

  private:
    static constexpr std::size_t kMostFrames = 1000000;  ///< nine hours; then the oldest go

    void on_keyframe(const messages::RawMessage& message);
    void add(const Keyframe& keyframe);
    void took(const keyframe_t& received);
    void resume();
    void on_surfaces(const messages::RawMessage& message);
    void adopt(const Surfaces& surfaces);
    void apply_finished();
    void on_odometry(const messages::RawMessage& message);
    void write_trajectories();
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
    messages::KeyframeGuard keyframe_guard_{status_};
    messages::StreamGuard surfaces_guard_{messages::channels::kSurfaces, "surfaces of the map", status_,
                                          false};
    std::optional<Surfaces> waiting_surfaces_;  ///< that came while the background was at work
    bool has_new_surfaces_ = false;
    GraphCounts told_;  ///< to the status
    std::int32_t seq_ = 0;
    std::int64_t published_us_ = 0;    ///< wall clock of the last trajectory; 0: none yet
    std::optional<int> last_refused_;  ///< id of the last keyframe that was left out
    int refused_in_row_ = 0;           ///< with ids one after the other
    bool odometry_started_again_ = false;
    std::unique_ptr<GraphJournal> journal_;  ///< null without
    std::filesystem::path output_;
    std::deque<FramePose> frames_;  ///< where the frames were, at most kMostFrames
    KeyframePoses poses_;
    std::set<int> lately_;  ///< ids of the last keyframes that were taken
};

}  // namespace planemap::graph
