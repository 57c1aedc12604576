// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/features.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "places/matching.hpp"

namespace planemap::odometry {
namespace {

constexpr double kOutlineMargin = 0.02;  // metres
constexpr double kSecondBest = 0.85;     // a match's distance over the second-best's
constexpr int kImageBorder = 8;          // pixels without corners: a tracker's window must fit

}  // namespace

cv::Mat as_mat(const GrayImage& gray) {
    return {gray.height, gray.width, CV_8UC1, const_cast<std::uint8_t*>(gray.pixels.data())};
}

double sound_depth(const DepthImage& depth, const CameraInfo& info, const Eigen::Vector2d& pixel,
                   double max_spread) {
    const int u0 = static_cast<int>(std::lround(pixel.x())), v0 = static_cast<int>(std::lround(pixel.y()));
    if (u0 < 2 || v0 < 2 || u0 + 2 >= depth.width || v0 + 2 >= depth.height) return 0;
    int lowest = std::numeric_limits<int>::max(), highest = 0, valid = 0, near = 0;
    double inverse_sum = 0;
    for (int v = v0 - 2; v <= v0 + 2; ++v) {
        const std::uint16_t* row = depth.row(v);
        for (int u = u0 - 2; u <= u0 + 2; ++u) {
            if (!is_valid_depth(row[u])) continue;
            lowest = std::min<int>(lowest, row[u]);
            highest = std::max<int>(highest, row[u]);
            ++valid;
            if (std::abs(u - u0) > 1 || std::abs(v - v0) > 1) continue;
            inverse_sum += 1.0 / row[u];
            ++near;
        }
    }
    if (valid < 15 || near < 5) return 0;
    const double z = near / inverse_sum / info.depth_units_per_metre;
    const double spread = (highest - lowest) / info.depth_units_per_metre;
    if (z < info.depth_min_m || z > info.depth_max_m) return 0;
    return spread <= max_spread * z + 2 * info.noise.sigma(z) ? z : 0;
}

namespace {

/// The strongest corners with sound depth, one a cell.
std::vector<cv::Point2f> best_of_cells(std::vector<cv::KeyPoint> corners, const DepthImage& depth,
                                       const CameraInfo& info, const CornerOptions& options) {
    std::stable_sort(corners.begin(), corners.end(),
                     [](const auto& a, const auto& b) { return a.response > b.response; });
    Image<char> taken(depth.width / options.cell_px + 1, depth.height / options.cell_px + 1);
    std::vector<cv::Point2f> chosen;
    for (const cv::KeyPoint& corner : corners) {
        if (static_cast<int>(chosen.size()) >= options.max_corners) break;
        const int u = static_cast<int>(corner.pt.x), v = static_cast<int>(corner.pt.y);
        if (u < kImageBorder || v < kImageBorder || u >= depth.width - kImageBorder ||
            v >= depth.height - kImageBorder)
            continue;
        char& cell = taken(u / options.cell_px, v / options.cell_px);
        if (cell || sound_depth(depth, info, {u, v}, options.max_depth_spread) == 0) continue;
        cell = 1;
        chosen.push_back(corner.pt);
    }
    return chosen;
}

}  // namespace

CornerOptions corner_options(const OdometryOptions& options) {
    return {options.max_points, options.cell_px, options.corner_threshold, options.max_depth_spread};
}

std::vector<cv::Point2f> select_corners(const GrayImage& gray, const DepthImage& depth,
                                        const CameraInfo& info, const CornerOptions& options) {
    std::vector<cv::KeyPoint> corners;
    cv::FAST(as_mat(gray), corners, options.threshold, true);
    std::vector<cv::Point2f> chosen = best_of_cells(std::move(corners), depth, info, options);
    if (static_cast<int>(chosen.size()) > options.max_corners / 2) return chosen;
    corners.clear();
    cv::FAST(as_mat(gray), corners, std::max(2, options.threshold / 3), true);
    chosen = best_of_cells(std::move(corners), depth, info, options);
    if (static_cast<int>(chosen.size()) > options.max_corners / 6) return chosen;
    // Crisp edges (screens, chequers) give FAST equal scores side by side, which its suppression drops all.
    std::vector<cv::Point2f> strong;
    cv::goodFeaturesToTrack(as_mat(gray), strong, options.max_corners, 0.02, options.cell_px / 2.0);
    corners.clear();
    for (std::size_t i = 0; i < strong.size(); ++i)
        corners.emplace_back(strong[i], 7.0f, -1.0f, static_cast<float>(strong.size() - i));
    std::vector<cv::Point2f> others = best_of_cells(std::move(corners), depth, info, options);
    return others.size() > chosen.size() ? others : chosen;
}

std::vector<Feature> describe(const GrayImage& gray, const DepthImage& depth, const CameraInfo& info,
                              int max_features, double max_depth_spread) {
    // Some features have no sound depth: a quarter more are looked for.
    const cv::Ptr<cv::ORB> orb =
        cv::ORB::create(max_features * 5 / 4, 1.5f, 3, 24, 0, 2, cv::ORB::FAST_SCORE, 24, 15);
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    orb->detectAndCompute(as_mat(gray), cv::noArray(), keypoints, descriptors);
    std::vector<Feature> features;
    for (std::size_t i = 0; i < keypoints.size(); ++i) {
        if (static_cast<int>(features.size()) >= max_features) break;
        const cv::Point2f& pixel = keypoints[i].pt;
        const double z = sound_depth(depth, info, {pixel.x, pixel.y}, max_depth_spread);
        if (z == 0) continue;
        Feature feature;
        feature.pixel = {pixel.x, pixel.y};
        feature.point = info.color.unproject(pixel.x, pixel.y, z).cast<float>();
        std::memcpy(feature.descriptor.data(), descriptors.ptr(static_cast<int>(i)),
                    feature.descriptor.size());
        features.push_back(feature);
    }
    return features;
}

int region_of(std::span<const PlanarRegion> regions, const Eigen::Vector3d& point, double depth_sigma) {
    int best = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const Plane& plane = regions[i].plane;
        const double off = std::abs(plane.signed_distance(point));
        const double slant = std::abs(plane.normal.dot(point)) / point.z();
        if (off > 3 * depth_sigma * slant + regions[i].rms || off >= nearest) continue;
        if (distance(regions[i], plane.project(point)) > kOutlineMargin) continue;
        best = static_cast<int>(i);
        nearest = off;
    }
    return best;
}

Eigen::Vector3d regularised(const Plane& plane, const Eigen::Vector3d& point) {
    const double along = plane.normal.dot(point);
    if (std::abs(along) < 0.1 * point.norm()) return point;
    return point * (-plane.d / along);
}

std::vector<std::pair<int, int>> match_descriptors(std::span<const Feature> a, std::span<const Feature> b,
                                                   int max_distance) {
    constexpr int kFar = 257;
    std::vector<int> best_of_b(b.size(), -1), distance_of_b(b.size(), kFar);
    std::vector<int> best_of_a(a.size(), -1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int best = kFar, second = kFar;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int bits = places::hamming_distance(a[i].descriptor, b[j].descriptor);
            if (bits < distance_of_b[j]) {
                distance_of_b[j] = bits;
                best_of_b[j] = static_cast<int>(i);
            }
            if (bits < best) {
                second = best;
                best = bits;
                best_of_a[i] = static_cast<int>(j);
            } else {
                second = std::min(second, bits);
            }
        }
        if (best > max_distance || best > kSecondBest * second) best_of_a[i] = -1;
    }
    std::vector<std::pair<int, int>> matches;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int j = best_of_a[i];
        if (j >= 0 && best_of_b[static_cast<std::size_t>(j)] == static_cast<int>(i))
            matches.emplace_back(static_cast<int>(i), j);
    }
    return matches;
}

}  // namespace planemap::odometry
