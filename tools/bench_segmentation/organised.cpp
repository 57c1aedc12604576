// SPDX-License-Identifier: BSD-3-Clause
// PCL_NO_PRECOMPILE: our own instantiations, with the project's flags, as for ransac. Not of the search
// trees, which an organised cloud does without: their headers come first.
#include <pcl/search/kdtree.h>
#define PCL_NO_PRECOMPILE

#include <pcl/console/print.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>

#include <limits>

#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/peers.hpp"

namespace planemap::bench {

namespace {

class OrganisedFinder : public benchmark::Finder {
  public:
    explicit OrganisedFinder(int min_inliers) {
        normals_.setNormalEstimationMethod(normals_.AVERAGE_3D_GRADIENT);
        normals_.setMaxDepthChangeFactor(0.02f);
        normals_.setNormalSmoothingSize(10.0f);
        planes_.setMinInliers(static_cast<unsigned>(min_inliers));
    }

    void find(const DepthImage& depth, const CameraInfo& camera) override {
        const auto cloud = make_cloud(depth, camera);
        const auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
        normals_.setInputCloud(cloud);
        normals_.compute(*normals);
        planes_.setInputCloud(cloud);
        planes_.setInputNormals(normals);
        regions_.clear(), coefficients_.clear(), inliers_.clear();
        std::vector<pcl::PointIndices> label_indices, boundary_indices;
        auto labels = std::make_shared<pcl::PointCloud<pcl::Label>>();
        planes_.segmentAndRefine(regions_, coefficients_, inliers_, labels, label_indices, boundary_indices);
        width_ = depth.width;
        height_ = depth.height;
    }

    void result(segmentation::Segmentation& out) override {
        out.regions.assign(coefficients_.size(), {});
        out.labels = Image<std::uint16_t>(width_, height_);
        for (std::size_t i = 0; i < coefficients_.size(); ++i) {
            const std::vector<float>& c = coefficients_[i].values;
            const Plane plane{Eigen::Vector3f(c[0], c[1], c[2]).cast<double>().normalized(), c[3]};
            out.regions[i].plane = plane.d < 0 ? plane.flipped() : plane;
            for (const auto index : inliers_[i].indices)
                out.labels.pixels[static_cast<std::size_t>(index)] = static_cast<std::uint16_t>(i + 1);
            out.regions[i].moments.count = static_cast<double>(inliers_[i].indices.size());
        }
    }

  private:
    using Point = pcl::PointXYZ;

    static pcl::PointCloud<Point>::Ptr make_cloud(const DepthImage& depth, const CameraInfo& camera) {
        constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
        const auto width = static_cast<std::uint32_t>(depth.width);
        auto cloud = std::make_shared<pcl::PointCloud<Point>>(width, static_cast<std::uint32_t>(depth.height),
                                                              Point(kNone, kNone, kNone));
        cloud->is_dense = false;
        for_each_reading(depth, camera, [&](int u, int v, double z) {
            const std::size_t i = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
            (*cloud)[i].getVector3fMap() = camera.depth.unproject(u, v, z).cast<float>();
        });
        return cloud;
    }

    pcl::IntegralImageNormalEstimation<Point, pcl::Normal> normals_;
    pcl::OrganizedMultiPlaneSegmentation<Point, pcl::Normal, pcl::Label> planes_;
    std::vector<pcl::PlanarRegion<Point>, Eigen::aligned_allocator<pcl::PlanarRegion<Point>>> regions_;
    std::vector<pcl::ModelCoefficients> coefficients_;
    std::vector<pcl::PointIndices> inliers_;
    int width_ = 0, height_ = 0;
};

}  // namespace

std::unique_ptr<benchmark::Finder> make_organised(int min_inliers) {
    return std::make_unique<OrganisedFinder>(min_inliers);
}

void silence_pcl() {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
}

}  // namespace planemap::bench
