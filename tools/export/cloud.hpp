// SPDX-License-Identifier: BSD-3-Clause
// The readings of a recording as a cloud, coloured by the planes that explain them.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/cloud_point.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"
#include "evaluate/map_faces.hpp"
#include "export/cloud_options.hpp"
#include "sensor/source.hpp"

namespace planemap {

/// Collects readings, of each cube of space the first one, in the map's world frame.
class CloudMaker {
  public:
    CloudMaker(const PlaneMap& map, const CloudOptions& options);

    /// Every second reading in x and y that the sensor is trusted with, of each frame others. The image is
    /// the depth camera's, without distortion.
    void add(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_camera);

    /// In the order in which they were seen. Colours are the planes' (id_color()), grey for no plane.
    const std::vector<CloudPoint>& points() const { return points_; }
    /// Side of a cube, as it has grown.
    double voxel_m() const { return voxel_m_; }

  private:
    bool is_new(const Eigen::Vector3d& p_world);
    void thin();

    std::vector<evaluation::MapFace> faces_;
    CloudOptions options_;
    double voxel_m_;
    std::vector<CloudPoint> points_;
    std::unordered_set<std::uint64_t> seen_;  ///< cubes
    unsigned frames_ = 0;
};

struct Cloud {
    std::vector<CloudPoint> points;  ///< world frame
    double voxel_m = 0;
    std::int64_t frames = 0, placed = 0;  ///< of the recording; of these, with a pose
    std::vector<std::string> remarks;     ///< what the user should know, a line each
};

/// Reads a recording to its end. A frame's pose is the trajectory's for its stamps, or between two poses at
/// most 0.1 s apart; frames without one are left out. Throws std::runtime_error or std::invalid_argument with
/// one line: what sensor::open_source() throws, a live camera, a recording of which no frame has a pose or a
/// reading.
Cloud cloud_of(const std::string& recording, const sensor::SourceOptions& source, const CloudOptions& options,
               const PlaneMap& map, const Trajectory& trajectory);

}  // namespace planemap
