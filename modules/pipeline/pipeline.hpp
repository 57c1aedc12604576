// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/frame_poses.hpp"
#include "core/keyframe.hpp"
#include "core/replacement.hpp"
#include "core/trajectory.hpp"
#include "graph/graph_shell.hpp"
#include "map/map_shell.hpp"
#include "messages/bus.hpp"
#include "messages/frame_decoder.hpp"
#include "octomap/octomap_shell.hpp"
#include "odometry/odometry_shell.hpp"
#include "pipeline/given_poses.hpp"
#include "segmentation/segmentation_shell.hpp"

namespace planemap::pipeline {

struct PipelineOptions {
    segmentation::SegmentationOptions segmentation;
    odometry::OdometryOptions odometry;
    graph::GraphOptions graph;
    planemap::map::MapShellOptions map;
    octomap::OctomapOptions octomap;
    bool with_graph = true;           ///< without it there is no map either
    std::optional<Trajectory> poses;  ///< instead of the graph's
    bool with_map = true;
    bool with_octomap = true;
    bool keep_estimates = true;        ///< of all frames, for trajectory(); without: of the newest only
    std::optional<CameraInfo> camera;  ///< instead of what the bus says
};

/// All shells on one bus in one process: the same ones that run as processes, fed one frame after the other.
/// With a memq:// bus nothing is lost, and the same input and options give the same result.
class Pipeline {
  public:
    Pipeline(messages::Bus& bus, const PipelineOptions& options);

    /// Handles what was published until the bus is quiet.
    void settle() { bus_.drain(); }
    /// Handles what the shells still hold back, and brings all maps up to date.
    void finish();

    /// The newest estimate; nothing before the first frame.
    const OdometryEstimate* latest() const { return estimates_.empty() ? nullptr : &estimates_.back(); }
    /// One for each frame that reached the odometry, in order.
    const std::vector<OdometryEstimate>& estimates() const { return estimates_; }
    /// World poses of the keyframes: the graph's, or the given ones. Precondition: one of both.
    const KeyframeTrajectory& keyframes() const;
    /// World poses of the tracked frames of the largest component after graph optimisation, at the moments
    /// that they are of; without a graph their poses in the odom frame, with given poses these.
    Trajectory trajectory() const;
    /// The same of all components, the largest first; at least one.
    std::vector<ComponentTrajectory> trajectories() const;

    /// Why most frames that were not tracked were not, where that is known: a clause.
    std::optional<std::string> reason_lost();
    /// The same, or what is left when no other reason is known: words to follow a colon.
    std::string why_lost();

    /// What went wrong on the bus, by its kind.
    const messages::Complaints& complaints() const { return bus_.complaints(); }
    messages::FrameDecoder& decoder() { return *decoder_; }
    segmentation::SegmentationShell& segmentation() { return segmentation_; }
    odometry::OdometryShell& odometry() { return odometry_; }
    graph::GraphShell* graph() { return graph_.get(); }                   ///< nullptr without one
    const GivenPoses* given_poses() const { return given_poses_.get(); }  ///< nullptr without
    planemap::map::MapShell& map() { return *map_; }  ///< precondition: with_map, and a graph or given poses
    octomap::OctomapShell* octomap() { return octomap_.get(); }

  private:
    void finish_graph();

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    segmentation::SegmentationShell segmentation_;
    odometry::OdometryShell odometry_;
    std::unique_ptr<graph::GraphShell> graph_;
    std::unique_ptr<GivenPoses> given_poses_;
    std::unique_ptr<planemap::map::MapShell> map_;
    std::unique_ptr<octomap::OctomapShell> octomap_;
    std::vector<OdometryEstimate> estimates_;
    KeyframePoses poses_;  ///< by the graph's trajectories
};

}  // namespace planemap::pipeline
