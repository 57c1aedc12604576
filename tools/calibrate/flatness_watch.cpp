// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/flatness_watch.hpp"

#include <Eigen/Cholesky>
#include <vector>

#include "core/depth_correction.hpp"

namespace planemap {

namespace {

constexpr std::int64_t kEvery_us = 300000;
constexpr int kStride = 4;                   // pixels
constexpr double kReadingsWorth = 1.0 / 50;  // of a reading's information: its neighbours err alike
constexpr int kLeastReadings = 100;          // of a region

using graph::Flatness;

/// Readings of one region: inverse depth + field = a plane's, linear in the direction.
class RegionSum {
  public:
    void add(const FieldWeights& field, const Eigen::Vector3d& direction, double inverse, double weight) {
        ++count_;
        Flatness::Field row = Flatness::Field::Zero();
        for (std::size_t k = 0; k < 4; ++k) row[static_cast<int>(field.nodes[k])] += field.weights[k];
        field_ += weight * row * row.transpose();
        mixed_ += weight * row * direction.transpose();
        plane_ += weight * direction * direction.transpose();
        field_inverse_ += weight * inverse * row;
        plane_inverse_ += weight * inverse * direction;
    }
    /// What is left when the plane is not known.
    void tell(Flatness& flatness) const {
        if (count_ < kLeastReadings) return;
        const Eigen::LDLT<Eigen::Matrix3d> plane(plane_);
        if (plane.info() != Eigen::Success || !(plane.rcond() > 1e-9)) return;
        flatness.information += field_ - mixed_ * plane.solve(mixed_.transpose());
        flatness.pull += mixed_ * plane.solve(plane_inverse_) - field_inverse_;
        ++flatness.regions;
    }

  private:
    int count_ = 0;
    Flatness::Information field_ = Flatness::Information::Zero();
    Eigen::Matrix<double, DepthCorrection::kNodes, 3> mixed_ =
        Eigen::Matrix<double, DepthCorrection::kNodes, 3>::Zero();
    Eigen::Matrix3d plane_ = Eigen::Matrix3d::Zero();
    Flatness::Field field_inverse_ = Flatness::Field::Zero();
    Eigen::Vector3d plane_inverse_ = Eigen::Vector3d::Zero();
};

}  // namespace

FlatnessWatch::FlatnessWatch(messages::FrameDecoder& decoder) : segmenter_(segmentation::make_segmenter({})) {
    constexpr int kWaiting = 30;  // frames
    decoder.subscribe(
        status_, kWaiting, [this](const std::shared_ptr<const messages::Frame>& frame) { hear(*frame); },
        false);
}

void FlatnessWatch::hear(const messages::Frame& frame) {
    if (flatness_.regions > 0 && frame.utime() < next_utime_) return;
    next_utime_ = frame.utime() + kEvery_us;
    segmenter_->label(frame.depth(), frame.camera(), segmentation_);
    add(frame.depth(), segmentation_.labels, frame.sensed_camera());
}

void FlatnessWatch::add(const DepthImage& depth, const Image<std::uint16_t>& labels,
                        const CameraInfo& camera) {
    std::vector<RegionSum> regions;
    for (int v = kStride / 2; v < depth.height; v += kStride) {
        for (int u = kStride / 2; u < depth.width; u += kStride) {
            const std::size_t label = labels(u, v);
            if (label == 0 || !is_valid_depth(depth(u, v))) continue;
            if (label >= regions.size()) regions.resize(label + 1);
            const double z = camera.metres(depth(u, v)), sigma = camera.noise.sigma(z) / (z * z);
            regions[label].add(field_weights(camera, u, v), camera.depth.unproject(u, v, 1), 1 / z,
                               kReadingsWorth / (sigma * sigma));
        }
    }
    for (const RegionSum& region : regions) region.tell(flatness_);
}

}  // namespace planemap
