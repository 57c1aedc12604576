// SPDX-License-Identifier: BSD-3-Clause
#include "export/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/id_color.hpp"
#include "core/number_text.hpp"
#include "core/trajectory_file.hpp"
#include "evaluate/soundness.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "run/input.hpp"

namespace planemap {

namespace {

constexpr int kStride = 2;                    // pixels
constexpr std::int64_t kMostGap_us = 100000;  // between poses
constexpr double kLeastExplained = 0.2;       // of a cloud; of whole maps it is 0.6 and more
constexpr std::int64_t kCubes = 1 << 20;      // from the world's origin, along each axis

/// The cube that a point is in; nothing for one that is out of reach.
std::optional<std::uint64_t> cube_of(const Eigen::Vector3d& p_world, double voxel_m) {
    std::uint64_t cube = 0;
    for (int i = 0; i < 3; ++i) {
        const double place = std::floor(p_world[i] / voxel_m);
        if (!(std::abs(place) < static_cast<double>(kCubes))) return std::nullopt;
        cube = cube << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(place) + kCubes);
    }
    return cube;
}

std::optional<Pose> pose_of(const messages::Frame& frame, const Trajectory& trajectory) {
    if (frame.color_utime() != 0) {
        if (auto exact = pose_at(trajectory, frame.color_utime(), 0)) return exact;
    }
    return pose_at(trajectory, frame.utime(), kMostGap_us);
}

/// Puts every frame of a recording that has a pose into the cloud.
struct Collector {
    const Trajectory& trajectory;
    CloudMaker& maker;
    std::int64_t placed = 0;
    std::int64_t first_utime = 0, last_utime = 0;
    std::string fault;  ///< of the first frame that could not be decoded

    void hear(const messages::Frame& frame) {
        if (first_utime == 0) first_utime = frame.utime();
        last_utime = frame.utime();
        const auto world_from_camera = pose_of(frame, trajectory);
        if (!world_from_camera) return;
        try {
            maker.add(frame.depth(), frame.camera(), *world_from_camera);
            ++placed;
        } catch (const messages::MessageError& error) {
            if (fault.empty()) fault = error.what();
        }
    }
};

double explained_share(const std::vector<CloudPoint>& points) {
    const auto explained = std::count_if(points.begin(), points.end(), [](const CloudPoint& point) {
        return point.plane != CloudPoint::kNoPlane;
    });
    return static_cast<double>(explained) / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

void refuse_live(const std::string& recording) {
    if (sensor::kind_of_input(recording) == sensor::InputKind::kCamera && !recording.ends_with(".oni"))
        throw std::invalid_argument(recording + ": a live camera is no recording of this map");
}

}  // namespace

CloudMaker::CloudMaker(const PlaneMap& map, const CloudOptions& options)
    : faces_(evaluation::faces_of(map)), options_(options), voxel_m_(options.voxel_m) {
    options_.validate();
}

void CloudMaker::add(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_camera) {
    const Pose world_from_depth = world_from_camera * camera.color_from_depth;
    const unsigned number = frames_++;
    const int first_u = static_cast<int>(number % kStride),
              first_v = static_cast<int>(number / kStride % kStride);
    const evaluation::SoundnessLimits limits;
    for (int v = first_v; v < depth.height; v += kStride) {
        for (int u = first_u; u < depth.width; u += kStride) {
            const double z = camera.metres(depth(u, v));
            if (!is_valid_depth(depth(u, v)) || z < camera.depth_min_m || z > camera.depth_max_m) continue;
            const Eigen::Vector3d p = world_from_depth * camera.depth.unproject(u, v, z);
            if (!is_new(p)) continue;
            CloudPoint& point = points_.emplace_back();
            point.position = p.cast<float>();
            const auto face = evaluation::nearest_face(faces_, p, limits.band_m(camera.noise.sigma(z)));
            if (!face) continue;
            point.plane = faces_[face->index].id;
            point.color = id_color(point.plane);
        }
    }
    while (points_.size() > static_cast<std::size_t>(options_.most)) thin();
}

bool CloudMaker::is_new(const Eigen::Vector3d& p_world) {
    const auto cube = cube_of(p_world, voxel_m_);
    return cube && seen_.insert(*cube).second;
}

void CloudMaker::thin() {
    voxel_m_ *= 2;
    seen_.clear();
    std::size_t kept = 0;
    for (const CloudPoint& point : points_)
        if (is_new(point.position.cast<double>())) points_[kept++] = point;
    points_.resize(kept);
}

Cloud cloud_of(const std::string& recording, const sensor::SourceOptions& source, const CloudOptions& options,
               const PlaneMap& map, const Trajectory& trajectory) {
    refuse_live(recording);
    CloudMaker maker(map, options);
    Collector collector{trajectory, maker, 0, 0, 0, {}};
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus, source.camera);
    messages::ModuleStatus status("export");
    constexpr int kWaiting = 30;  // frames
    decoder.subscribe(status, kWaiting,
                      [&](const std::shared_ptr<const messages::Frame>& frame) { collector.hear(*frame); });
    const std::unique_ptr<Input> input = open_input(recording, bus, source);
    while (!messages::stop_requested() && input->feed())
        while (bus.handle(0)) {
        }
    if (messages::stop_requested()) throw std::runtime_error("stopped; nothing is written");
    if (!input->failure().empty()) throw std::runtime_error(input->failure());

    Cloud cloud{maker.points(), maker.voxel_m(), input->frames(), collector.placed, input->complaints()};
    if (!collector.fault.empty()) cloud.remarks.push_back(recording + ": " + collector.fault);
    if (cloud.placed == 0)
        throw std::runtime_error(recording + ": none of its " + std::to_string(cloud.frames) + " frames (" +
                                 span_text(collector.first_utime, collector.last_utime) +
                                 ") has a pose; the trajectory covers " + span_text(trajectory));
    if (cloud.points.empty()) throw std::runtime_error(recording + ": has no depth readings");
    if (cloud.placed < cloud.frames)
        cloud.remarks.push_back(recording + ": " + std::to_string(cloud.frames - cloud.placed) + " of its " +
                                std::to_string(cloud.frames) +
                                " frames have no pose and are not in the cloud");
    if (explained_share(cloud.points) < kLeastExplained)
        cloud.remarks.push_back(
            recording + ": only " + short_number_text(std::round(100 * explained_share(cloud.points))) +
            " % of the cloud lies on planes of the map: is it the map, and the trajectory, of "
            "this recording?");
    if (cloud.voxel_m > options.voxel_m)
        cloud.remarks.push_back("the cloud has a point every " + short_number_text(cloud.voxel_m) +
                                " m, as finer it would have had more than " + std::to_string(options.most));
    return cloud;
}

}  // namespace planemap
