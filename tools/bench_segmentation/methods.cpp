// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/methods.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/metrics.hpp"
#include "bench_segmentation/peers.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/rgbd_plane.hpp"
#include "segmentation/cells.hpp"
#include "segmentation/ransac.hpp"

namespace planemap::bench {

namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kMaxSubsampling = 16;

enum class Outlines { kNone, kTraced };

/// The project's own interface as a Finder.
class SegmenterFinder : public benchmark::Finder {
  public:
    SegmenterFinder(std::unique_ptr<segmentation::Segmenter> segmenter, Outlines outlines)
        : segmenter_(std::move(segmenter)), outlines_(outlines) {}

    void find(const DepthImage& depth, const CameraInfo& camera) override {
        if (outlines_ == Outlines::kTraced) {
            segmenter_->segment(depth, camera, segmentation_);
        } else {
            segmenter_->label(depth, camera, segmentation_);
        }
    }
    void result(segmentation::Segmentation& out) override { out = segmentation_; }

  private:
    std::unique_ptr<segmentation::Segmenter> segmenter_;
    Outlines outlines_;
    segmentation::Segmentation segmentation_;
};

/// The paper's settings.
segmentation::RansacOptions ransac_options(int subsampling) {
    segmentation::RansacOptions options;
    options.subsampling = subsampling;
    options.max_iterations = 1000;
    options.max_planes = 3;
    return options;
}

/// Does its own subsampling.
bool is_ransac(const std::string& name) {
    return name.starts_with("ransac");
}

std::unique_ptr<benchmark::Finder> make_finder(const MethodName& method) {
    silence_pcl();
    const int step = method.subsampling;
    const auto ours = [](std::unique_ptr<segmentation::Segmenter> segmenter,
                         Outlines outlines = Outlines::kNone) {
        return std::make_unique<SegmenterFinder>(std::move(segmenter), outlines);
    };
    if (method.name == "cells") return ours(segmentation::make_cell_segmenter({}));
    if (method.name == "cells-outlines")
        return ours(segmentation::make_cell_segmenter({}), Outlines::kTraced);
    if (method.name == "ransac")
        return ours(segmentation::make_ransac_segmenter(ransac_options(step), kSeed));
    if (method.name == "ransac-debian")
        return ours(make_debian_ransac_segmenter(ransac_options(step), kSeed));
    if (method.name == "organised") return make_organised(std::max(3, 1000 / (step * step)));
    const int block_px = benchmark::rgbd_plane_block_px(step);
    if (method.name == "rgbdplane") return benchmark::make_rgbd_plane(block_px, false);
    if (method.name == "rgbdplane-normals") return benchmark::make_rgbd_plane(block_px, true);
    throw std::invalid_argument("no method \"" + method.name + "\"");
}

void append(const std::string& word, std::vector<MethodName>& methods) {
    const auto slash = word.find('/');
    const MethodInfo& info = benchmark::named("methods", word.substr(0, slash), known_methods());
    if (slash == std::string::npos) {
        for (const int step : info.subsamplings) methods.push_back({info.name, step});
        return;
    }
    int step = 0;
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data() + slash + 1, end, step);
    if (error != std::errc{} || rest != end || step < 1 || step > kMaxSubsampling) {
        throw std::invalid_argument("methods: \"" + word +
                                    "\" must be NAME/N with a subsampling N from 1 to " +
                                    std::to_string(kMaxSubsampling));
    }
    methods.push_back({info.name, step});
}

}  // namespace

const std::vector<MethodInfo>& known_methods() {
    static const std::vector<MethodInfo> methods{
        {"cells", "the project's default method", {1, 2, 4}, {}},
        {"cells-outlines", "the same with outlines and boxes, as the module publishes it", {1}, {}},
        {"ransac", "the paper's: PCL's RANSAC, 1000 iterations, 3 planes", {1, 2, 4}, {1, 2}},
        {"ransac-debian", "the same with Debian's build of PCL's templates", {4}, {1, 2, 4}},
        {"organised", "PCL's organised multi-plane segmentation, 3D-gradient normals", {1}, {1}},
        {"rgbdplane", "OpenCV's RgbdPlane without normals", {4}, {1, 2}},
        {"rgbdplane-normals", "OpenCV's RgbdPlane with FALS normals", {4}, {1, 2}},
    };
    return methods;
}

bool is_slow(const MethodName& method) {
    const std::vector<int>& slow =
        benchmark::named("methods", method.name, known_methods()).slow_subsamplings;
    return std::count(slow.begin(), slow.end(), method.subsampling) > 0;
}

std::vector<MethodName> parse_methods(const std::string& list) {
    std::vector<MethodName> methods;
    benchmark::for_each_word("methods", list, [&](const std::string& word) { append(word, methods); });
    return methods;
}

Image<std::uint16_t> spread(const Image<std::uint16_t>& labels, const std::vector<PlanarRegion>& regions,
                            const DepthImage& depth, const CameraInfo& camera, int step) {
    Image<std::uint16_t> out(depth.width, depth.height);
    for_each_reading(depth, camera, [&](int u, int v, double z) {
        const auto nearest = [&](int pixel, int size) {
            return std::min((pixel + step / 2) / step, size - 1);
        };
        const std::uint16_t label = labels(nearest(u, labels.width), nearest(v, labels.height));
        if (label == 0) return;
        const Plane& plane = regions[label - 1u].plane;
        if (std::abs(plane.signed_distance(camera.depth.unproject(u, v, z))) <= tolerance(z))
            out(u, v) = label;
    });
    return out;
}

Method::Method(const MethodName& name)
    : finder_(make_finder(name)), step_(is_ransac(name.name) ? 1 : name.subsampling) {}

double Method::run(const DepthImage& depth, const CameraInfo& camera) {
    return benchmark::timed_find(*finder_, depth, camera, step_);
}

const segmentation::Segmentation& Method::result(const DepthImage& depth, const CameraInfo& camera) {
    finder_->result(segmentation_);
    if (step_ > 1)
        segmentation_.labels = spread(segmentation_.labels, segmentation_.regions, depth, camera, step_);
    return segmentation_;
}

}  // namespace planemap::bench
