// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/rgbd_plane.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/rgbd/depth.hpp>

#include "evaluate/readings.hpp"

namespace planemap::benchmark {

namespace {

class RgbdPlaneFinder : public Finder {
  public:
    RgbdPlaneFinder(int block_px, bool with_normals)
        : planes_(cv::rgbd::RgbdPlane::RGBD_PLANE_METHOD_DEFAULT, block_px, block_px * block_px, 0.01,
                  0.0075),
          with_normals_(with_normals) {}

    void find(const DepthImage& depth, const CameraInfo& camera) override {
        make_points(depth, camera);
        if (!with_normals_) {
            planes_(points_, mask_, coefficients_);
            return;
        }
        const PinholeCamera& c = camera.depth;
        const cv::Matx33f intrinsics(static_cast<float>(c.fx), 0, static_cast<float>(c.cx), 0,
                                     static_cast<float>(c.fy), static_cast<float>(c.cy), 0, 0, 1);
        const cv::rgbd::RgbdNormals normals(depth.height, depth.width, CV_32F, intrinsics, 5,
                                            cv::rgbd::RgbdNormals::RGBD_NORMALS_METHOD_FALS);
        cv::Mat normal_image;
        normals(points_, normal_image);
        planes_(points_, normal_image, mask_, coefficients_);
    }

    void result(segmentation::Segmentation& out) override {
        out.regions.assign(coefficients_.size(), {});
        out.labels = Image<std::uint16_t>(points_.cols, points_.rows);
        for (std::size_t i = 0; i < coefficients_.size(); ++i) {
            const cv::Vec4f& c = coefficients_[i];
            const Eigen::Vector3d normal = Eigen::Vector3f(c[0], c[1], c[2]).cast<double>();
            const Plane plane{normal.normalized(), c[3] / normal.norm()};
            out.regions[i].plane = plane.d < 0 ? plane.flipped() : plane;
        }
        for (int v = 0; v < mask_.rows; ++v) {
            for (int u = 0; u < mask_.cols; ++u) {
                const auto label = static_cast<std::size_t>(mask_.at<unsigned char>(v, u));
                if (label >= coefficients_.size()) continue;
                out.labels(u, v) = static_cast<std::uint16_t>(label + 1);
                out.regions[label].moments.count += 1;
            }
        }
    }

  private:
    void make_points(const DepthImage& depth, const CameraInfo& camera) {
        constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
        points_.create(depth.height, depth.width, CV_32FC3);
        points_.setTo(cv::Scalar::all(kNone));
        evaluation::for_each_reading(depth, camera, [&](int u, int v, double z) {
            const Eigen::Vector3f p = camera.depth.unproject(u, v, z).cast<float>();
            points_.at<cv::Vec3f>(v, u) = {p.x(), p.y(), p.z()};
        });
    }

    cv::rgbd::RgbdPlane planes_;
    bool with_normals_;
    cv::Mat points_, mask_;
    std::vector<cv::Vec4f> coefficients_;
};

}  // namespace

std::unique_ptr<Finder> make_rgbd_plane(int block_px, bool with_normals) {
    cv::setNumThreads(1);
    return std::make_unique<RgbdPlaneFinder>(block_px, with_normals);
}

int rgbd_plane_block_px(int step) {
    return std::max(4, 40 / step);
}

}  // namespace planemap::benchmark
