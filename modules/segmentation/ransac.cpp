// SPDX-License-Identifier: BSD-3-Clause
// PCL_NO_PRECOMPILE: Debian's instantiations are built without vector instructions; our own, with the
// project's flags, take a fraction of the time. Alignment is the same in both (EIGEN_MAX_ALIGN_BYTES).
#define PCL_NO_PRECOMPILE

#include "segmentation/ransac.hpp"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "segmentation/shape.hpp"

namespace planemap::segmentation {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL's plane model, with a seed of our choice.
class SeededPlaneModel : public pcl::SampleConsensusModelPlane<pcl::PointXYZ> {
  public:
    SeededPlaneModel(const Cloud::ConstPtr& cloud, const pcl::Indices& indices, std::uint64_t seed)
        : pcl::SampleConsensusModelPlane<pcl::PointXYZ>(cloud, indices) {
        rng_alg_.seed(static_cast<std::uint32_t>(seed ^ (seed >> 32)));
    }
};

class RansacSegmenter : public Segmenter {
  public:
    RansacSegmenter(const RansacOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  private:
    void find(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) override {
        sample(depth, camera);
        out.regions.clear();
        out.labels.width = depth.width;
        out.labels.height = depth.height;
        out.labels.pixels.assign(depth.pixels.size(), 0);
        while (out.regions.size() < static_cast<std::size_t>(options_.max_planes)) {
            if (!extract_plane(out)) break;
        }
        sort_largest_first(out);
        spread_labels(depth, camera, out);
    }

    /// Fills cloud_ with every n-th point of every n-th row, and remaining_ with all their indices.
    void sample(const DepthImage& depth, const CameraInfo& camera) {
        const DepthRange range(camera);
        cloud_ = std::make_shared<Cloud>();
        pixel_of_.clear();
        for (int v = 0; v < depth.height; v += options_.subsampling) {
            for (int u = 0; u < depth.width; u += options_.subsampling) {
                if (!range.contains(depth(u, v))) continue;
                const Eigen::Vector3d p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
                cloud_->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                     static_cast<float>(p.z()));
                pixel_of_.emplace_back(u, v);
            }
        }
        remaining_.resize(cloud_->size());
        for (std::size_t i = 0; i < remaining_.size(); ++i) remaining_[i] = static_cast<int>(i);
    }

    /// Moves the largest plane's points from remaining_ to a new region; false when there is none left that
    /// is large enough.
    bool extract_plane(Segmentation& out) {
        if (remaining_.size() < static_cast<std::size_t>(options_.min_inliers)) return false;
        const auto model = std::make_shared<SeededPlaneModel>(cloud_, remaining_, seed_ + out.regions.size());
        pcl::RandomSampleConsensus<pcl::PointXYZ> ransac(model, options_.thickness_m);
        ransac.setMaxIterations(options_.max_iterations);
        ransac.setProbability(options_.probability);
        if (!ransac.computeModel()) return false;
        Eigen::VectorXf coefficients, refined;
        pcl::Indices inliers;
        ransac.getInliers(inliers);
        ransac.getModelCoefficients(coefficients);
        model->optimizeModelCoefficients(inliers, coefficients, refined);
        model->selectWithinDistance(refined, options_.thickness_m, inliers);
        if (inliers.size() < static_cast<std::size_t>(options_.min_inliers)) return false;

        PlanarRegion region;
        for (const int i : inliers)
            region.moments.add((*cloud_)[static_cast<std::size_t>(i)].getVector3fMap().cast<double>());
        const PlaneFit fit = fit_plane(region.moments);
        if (!fit.valid || !(fit.plane.d > 0)) return false;
        region.plane = fit.plane;
        region.rms = fit.rms;
        out.regions.push_back(std::move(region));
        for (const int i : inliers) {
            const auto [u, v] = pixel_of_[static_cast<std::size_t>(i)];
            out.labels(u, v) = static_cast<std::uint16_t>(out.regions.size());
        }
        std::sort(inliers.begin(), inliers.end());
        pcl::Indices rest;
        std::set_difference(remaining_.begin(), remaining_.end(), inliers.begin(), inliers.end(),
                            std::back_inserter(rest));
        remaining_ = std::move(rest);
        return true;
    }

    static void sort_largest_first(Segmentation& out) {
        std::vector<std::uint16_t> order(out.regions.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint16_t>(i);
        std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
            return out.regions[a].moments.count > out.regions[b].moments.count;
        });
        std::vector<PlanarRegion> sorted;
        std::vector<std::uint16_t> label_of(order.size() + 1, 0);
        for (const std::uint16_t i : order) {
            sorted.push_back(std::move(out.regions[i]));
            label_of[i + 1u] = static_cast<std::uint16_t>(sorted.size());
        }
        out.regions = std::move(sorted);
        for (std::uint16_t& label : out.labels.pixels) label = label_of[label];
    }

    /// Gives the pixels between the samples their sample's label where they lie within the thickness.
    void spread_labels(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) const {
        const DepthRange range(camera);
        const int step = options_.subsampling;
        for (int v = 0; v < depth.height && step > 1; ++v) {
            for (int u = 0; u < depth.width; ++u) {
                const std::uint16_t label = out.labels(u / step * step, v / step * step);
                if (label == 0 || !range.contains(depth(u, v))) continue;
                const Eigen::Vector3d p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
                if (std::abs(out.regions[label - 1u].plane.signed_distance(p)) <= options_.thickness_m)
                    out.labels(u, v) = label;
            }
        }
    }

    RansacOptions options_;
    std::uint64_t seed_;
    Cloud::Ptr cloud_;
    std::vector<std::pair<int, int>> pixel_of_;  // u, v of each point
    pcl::Indices remaining_;                     // ascending
};

}  // namespace

std::unique_ptr<Segmenter> make_ransac_segmenter(const RansacOptions& options, std::uint64_t seed) {
    options.validate();
    return std::make_unique<RansacSegmenter>(options, seed);
}

}  // namespace planemap::segmentation
