// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "odometry/features.hpp"
#include "odometry/ransac.hpp"

namespace planemap::odometry {
namespace {

constexpr double kPlaneAngle = 0.14;   // 8 degrees between the two views of a plane
constexpr double kPlaneGap = 0.3;      // metres within a plane between what the two views saw of it
constexpr int kSurfaceSteps = 8;       // with the wide gate, and as many with the narrow one
constexpr int kCoarseSteps = 10;       // at each pyramid level
constexpr double kCoarseStep = 0.002;  // metres and radians; smaller steps end a level
constexpr double kCoarseGate = 0.15;   // metres from the surface
constexpr int kFewPoints = 2;          // times the least that a pose needs

/// The points that flow found, as terms; depth is read where the point was at the depth image's time.
std::vector<PointTerm> make_terms(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess,
                                  const std::vector<cv::Point2f>& pixels,
                                  const std::vector<std::size_t>& found) {
    const PinholeCamera& camera = frame.camera->color;
    const Pose color_from_depth_time = pose_from_twist(frame.color_offset_s * guess.velocity);
    std::vector<PointTerm> terms;
    terms.reserve(found.size());
    for (const std::size_t i : found) {
        PointTerm term;
        term.point = keyframe.points[i].point;
        term.point_per_readout = keyframe.points[i].per_readout;
        term.pixel = {pixels[i].x, pixels[i].y};
        term.pixel_sigma = options.pixel_sigma_px;
        Eigen::Vector2d depth_pixel = term.pixel;
        const Eigen::Vector3d p = guess.camera_from_keyframe * term.point;
        const Eigen::Vector3d p_color = color_from_depth_time * p;
        if (p.z() > 0.05 && p_color.z() > 0.05) depth_pixel += camera.project(p) - camera.project(p_color);
        const double z = sound_depth(*frame.depth, *frame.camera, depth_pixel, options.max_depth_spread);
        if (z > 0) {
            const double sigma = options.depth_sigma_scale * frame.camera->noise.sigma(z) / (z * z);
            term.inverse_depth = 1 / z;
            term.inverse_depth_sigma = std::hypot(sigma, keyframe.points[i].inverse_depth_sigma);
        }
        terms.push_back(term);
    }
    return terms;
}

QuadraticTerm guess_term(const Guess& guess) {
    return {guess.camera_from_keyframe, guess.information, Twist::Zero(), true};
}

bool is_supported(const OdometryOptions& options, const AlignmentResult& result, std::size_t terms) {
    return result.converged && result.inliers >= options.min_inliers &&
           result.inliers >= options.min_inlier_share * static_cast<double>(terms);
}

/// An information in the guess's sigmas, in which directions are compared.
Matrix6d in_sigmas_of(const Guess& guess, const Matrix6d& information) {
    const Twist sigmas = guess.information.diagonal().cwiseSqrt().cwiseInverse();
    return sigmas.asDiagonal() * information * sigmas.asDiagonal();
}

/// What is left of the data's information without what noise pretends: less in no direction than the guess
/// says.
Matrix6d without_pretended(const Matrix6d& information, const Matrix6d& pretended, const Guess& guess) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
        in_sigmas_of(guess, information - guess.information - pretended));
    const Twist in_sigmas = guess.information.diagonal().cwiseSqrt();
    const Matrix6d half = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    const Matrix6d scaled = in_sigmas.asDiagonal() * half;
    return guess.information + scaled * scaled.transpose();
}

/// True when the data say too little about some direction compared with the guess.
bool is_degenerate(const Matrix6d& information, const Guess& guess) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(in_sigmas_of(guess, information - guess.information),
                                                        Eigen::EigenvaluesOnly);
    return !(eigen.eigenvalues()(0) > kWeakDirection);
}

Alignment make_alignment(const OdometryOptions& options, const PreparedFrame& frame, const Guess& guess) {
    Alignment alignment;
    alignment.camera = frame.camera->color;
    alignment.velocity = guess.velocity;
    alignment.color_offset_s = frame.color_offset_s;
    alignment.color_offset_sigma_s = options.color_jitter_s;
    alignment.readout_s = frame.readout_s;
    alignment.loss_scale = options.loss_scale;
    alignment.inlier_sigmas = options.inlier_sigmas;
    alignment.quadratics.push_back(guess_term(guess));
    return alignment;
}

/// Points alone: from the guess, and by RANSAC when that does not fit.
AlignmentResult align_robustly(const OdometryOptions& options, const Alignment& alignment,
                               const Guess& guess) {
    AlignmentResult result = align(alignment, guess.camera_from_keyframe);
    const auto terms = static_cast<double>(alignment.points.size());
    if (result.converged && result.inliers >= 0.5 * terms) return result;
    const std::optional<Pose> pose =
        ransac_motion(alignment.camera, alignment.points, motion_ransac_options(options));
    if (!pose) return result;
    // A guess that did not fit says nothing.
    Alignment free = alignment;
    free.quadratics[0].at = *pose;
    AlignmentResult other = align(free, *pose);
    return other.converged && other.inliers > result.inliers ? other : result;
}

std::vector<QuadraticTerm> geometry_terms(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                          const PreparedFrame& frame, const Pose& camera_from_keyframe,
                                          const Twist& velocity) {
    std::vector<QuadraticTerm> terms;
    if (options.surface_weight > 0)
        terms = match_patches(keyframe.patches, frame.camera->color,
                              without_shutter(frame.samples, frame.readout_s * velocity),
                              camera_from_keyframe, options.surface_gate_m, options.surface_weight)
                    .tiles;
    if (options.plane_points > 0)
        terms.push_back(match_planes(keyframe.regions, frame.regions, camera_from_keyframe,
                                     frame.camera->noise, options.plane_points));
    return terms;
}

}  // namespace

Twist Guess::velocity_at(const Pose& camera_from_keyframe) const {
    return velocity + velocity_gain.cwiseProduct(
                          twist_from_pose(camera_from_keyframe * predicted_from_keyframe.inverse()));
}

Matrix6d Located::covariance() const {
    return covariance_of(track.alignment);
}

QuadraticTerm match_planes(std::span<const PlanarRegion> keyframe_regions,
                           std::span<const PlanarRegion> regions, const Pose& camera_from_keyframe,
                           const DepthNoise& noise, double independent_points) {
    QuadraticTerm term;
    term.at = camera_from_keyframe;
    const Pose keyframe_from_camera = camera_from_keyframe.inverse();
    for (const PlanarRegion& region : regions) {
        const Eigen::Vector3d mean = region.moments.mean(), mean_keyframe = keyframe_from_camera * mean;
        const double sigma = 1.4 * noise.sigma(mean.z());
        const PlanarRegion* best = nullptr;
        double nearest = 0.02 + 3 * sigma;
        for (const PlanarRegion& other : keyframe_regions) {
            const Eigen::Vector3d normal = camera_from_keyframe.linear() * other.plane.normal;
            if (angle_between(normal, region.plane.normal) > kPlaneAngle) continue;
            const double off = std::abs(other.plane.signed_distance(mean_keyframe));
            if (off > nearest || distance(other, mean_keyframe) > kPlaneGap) continue;
            nearest = off;
            best = &other;
        }
        if (!best) continue;
        const Plane plane = camera_from_keyframe * best->plane;
        const double count = region.moments.count;
        const double weight = std::min(1.0, independent_points / count) / (sigma * sigma);
        const Eigen::Matrix3d a = skew(plane.normal);
        const Eigen::Vector3d &n = plane.normal, &s = region.moments.sum;
        term.information.topLeftCorner<3, 3>() += weight * count * n * n.transpose();
        term.information.topRightCorner<3, 3>() -= weight * n * (a * s).transpose();
        term.information.bottomRightCorner<3, 3>() += weight * a * region.moments.scatter * a.transpose();
        term.gradient.head<3>() -= weight * (n.dot(s) + count * plane.d) * n;
        term.gradient.tail<3>() += weight * a * (region.moments.scatter * n + plane.d * s);
    }
    term.information.bottomLeftCorner<3, 3>() = term.information.topRightCorner<3, 3>().transpose();
    return term;
}

namespace {

/// Where flow found the keyframe's points; one entry for each.
struct PointFlow {
    std::vector<cv::Point2f> pixels;
    std::vector<char> found;
    bool is_by_chance = false;  ///< see FlowResult

    explicit PointFlow(std::size_t points) : pixels(points), found(points, 0) {}
    std::vector<std::size_t> found_points() const {
        std::vector<std::size_t> indices;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (found[i]) indices.push_back(i);
        return indices;
    }
};

/// Flow of the points that the guess puts into the image.
PointFlow find_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                      const PreparedFrame& frame, const Guess& guess, const FlowSearch& search) {
    const Pose color_from_keyframe =
        pose_from_twist(frame.color_offset_s * guess.velocity) * guess.camera_from_keyframe;
    const PinholeCamera& camera = frame.camera->color;
    std::vector<std::size_t> indices;
    std::vector<cv::Point2f> from, to;
    for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
        if (search.usable && !(*search.usable)[i]) continue;
        const Eigen::Vector3d p = color_from_keyframe * keyframe.points[i].point;
        if (!(p.z() > 0.05)) continue;
        const Eigen::Vector2d pixel = camera.project(p);
        if (!camera.sees(pixel)) continue;
        indices.push_back(i);
        from.push_back((*search.from_pixels)[i]);
        to.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
    const FlowResult here = track_flow(*search.from, frame.pyramid, from, to, options.flow_window_px,
                                       search.levels, options.flow_iterations);
    PointFlow flow(keyframe.points.size());
    flow.is_by_chance = here.is_by_chance();
    for (std::size_t i = 0; i < indices.size(); ++i) {
        flow.pixels[indices[i]] = to[i];
        flow.found[indices[i]] = here.found[i];
    }
    return flow;
}

/// The pose from points that are already found.
std::optional<Track> align_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess, PointFlow flow) {
    const std::vector<std::size_t> indices = flow.found_points();
    if (flow.is_by_chance || static_cast<int>(indices.size()) < options.min_inliers) return std::nullopt;
    const std::vector<PointTerm> terms = make_terms(options, keyframe, frame, guess, flow.pixels, indices);
    Alignment alignment = make_alignment(options, frame, guess);
    alignment.points = terms;
    AlignmentResult result = align_robustly(options, alignment, guess);
    if (!is_supported(options, result, terms.size())) return std::nullopt;

    alignment.velocity = guess.velocity_at(result.camera_from_keyframe);
    const std::vector<QuadraticTerm> geometry =
        geometry_terms(options, keyframe, frame, result.camera_from_keyframe, alignment.velocity);
    alignment.quadratics.insert(alignment.quadratics.end(), geometry.begin(), geometry.end());
    const AlignmentResult joint = align(alignment, result.camera_from_keyframe);
    const bool agree = is_supported(options, joint, terms.size()) && joint.inliers > 0.8 * result.inliers;
    // Many points are right where geometry is matched wrongly; few are as likely to be wrong themselves.
    if (!agree && result.inliers < kFewPoints * options.min_inliers) return std::nullopt;
    if (agree) result = joint;

    Track track;
    track.by_features = true;
    track.tried = static_cast<int>(terms.size());
    track.inliers = result.inliers;
    track.degenerate = is_degenerate(result.information, guess);
    track.guess_information = guess.information;
    track.pixels = std::move(flow.pixels);
    track.inlier.assign(keyframe.points.size(), 0);
    for (std::size_t i = 0; i < indices.size(); ++i) track.inlier[indices[i]] = result.inlier[i];
    track.alignment = std::move(result);
    return track;
}

}  // namespace

std::optional<Track> track_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess, const FlowSearch& search) {
    if (frame.pyramid.empty() || search.from->empty()) return std::nullopt;
    return align_points(options, keyframe, frame, guess,
                        find_points(options, keyframe, frame, guess, search));
}

int count_points(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                 const Guess& guess, const FlowSearch& search) {
    if (frame.pyramid.empty() || search.from->empty()) return 0;
    const PointFlow flow = find_points(options, keyframe, frame, guess, search);
    const std::vector<PointTerm> terms =
        make_terms(options, keyframe, frame, guess, flow.pixels, flow.found_points());
    Alignment alignment = make_alignment(options, frame, guess);
    alignment.points = terms;
    const AlignmentResult result = align(alignment, guess.camera_from_keyframe);
    return result.converged ? result.inliers : 0;
}

std::optional<Track> track_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess, int levels) {
    const std::vector<cv::Point2f> pixels = keyframe.pixels();
    return track_points(options, keyframe, frame, guess, {&keyframe.pyramid, &pixels, nullptr, levels});
}

namespace {

/// The camera against the keyframe's surface and planes.
class SurfaceAlignment {
  public:
    SurfaceAlignment(const OdometryOptions& options, const LocalKeyframe& keyframe,
                     const PreparedFrame& frame, const Guess& guess)
        : options_(options),
          keyframe_(keyframe),
          frame_(frame),
          guess_(guess),
          pose_(guess.camera_from_keyframe) {}

    /// From where it is, at first with a wide gate if asked, with more information on the guess. False when
    /// it cannot be solved.
    bool settle(bool wide_first, const Matrix6d& steadying) {
        for (int i = wide_first ? 0 : kSurfaceSteps; i < 2 * kSurfaceSteps; ++i) {
            // Wide at first, then as narrow as the noise allows.
            match_ = match_at(options_.surface_gate_m * (i < kSurfaceSteps ? 3 : 1));
            Alignment alignment = make_alignment(options_, frame_, guess_);
            alignment.quadratics[0].information += steadying;
            alignment.quadratics.insert(alignment.quadratics.end(), match_.tiles.begin(), match_.tiles.end());
            alignment.quadratics.push_back(match_planes(keyframe_.regions, frame_.regions, pose_,
                                                        frame_.camera->noise, options_.plane_points));
            result_ = align(alignment, pose_);
            if (!result_.converged) return false;
            const Twist step = twist_from_pose(result_.camera_from_keyframe * pose_.inverse());
            pose_ = result_.camera_from_keyframe;
            if (step.norm() > 1e-4) continue;
            if (i >= kSurfaceSteps) break;
            i = kSurfaceSteps - 1;
        }
        const Matrix6d of_tilts =
            information_of_tilts(keyframe_.patches, frame_.camera->color, samples(), pose_,
                                 options_.surface_gate_m, options_.surface_weight);
        result_.information = without_pretended(result_.information - steadying, of_tilts, guess_);
        return true;
    }
    const PatchMatch& match() const { return match_; }
    const AlignmentResult& result() const { return result_; }

  private:
    std::vector<DepthSample> samples() const {
        return without_shutter(frame_.samples, frame_.readout_s * guess_.velocity_at(pose_));
    }
    PatchMatch match_at(double gate_m) const {
        return match_patches(keyframe_.patches, frame_.camera->color, samples(), pose_, gate_m,
                             options_.surface_weight);
    }

    const OdometryOptions& options_;
    const LocalKeyframe& keyframe_;
    const PreparedFrame& frame_;
    const Guess& guess_;
    Pose pose_;
    PatchMatch match_;
    AlignmentResult result_;
};

/// Information that holds the camera to the guess in directions that the surface hardly holds: there errors
/// of the keyframe's cells pull every frame alike, and lead it away frame by frame. Nothing where the guess
/// knows of no motion.
Matrix6d steadying(const Matrix6d& information, const Guess& guess) {
    if (guess.velocity_gain.isZero()) return Matrix6d::Zero();
    constexpr double kMost = 64;  // of what the guess itself says
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(in_sigmas_of(guess, information - guess.information));
    const Twist in_sigmas = guess.information.diagonal().cwiseSqrt();
    const Twist held = eigen.eigenvalues().cwiseMax(0) / kWeakDirection;
    const Twist weights = kMost * (1 + held.array().square()).inverse();
    const Matrix6d half = in_sigmas.asDiagonal() * eigen.eigenvectors();
    return half * weights.asDiagonal() * half.transpose();
}

}  // namespace

std::optional<Track> track_surface(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                   const PreparedFrame& frame, const Guess& guess) {
    if (frame.samples.empty() || keyframe.patches.cells() == 0) return std::nullopt;
    SurfaceAlignment surface(options, keyframe, frame, guess);
    if (!surface.settle(true, Matrix6d::Zero())) return std::nullopt;
    const Matrix6d held = steadying(surface.result().information, guess);
    if (!held.isZero() && !surface.settle(false, held)) return std::nullopt;
    const double needed = options.min_surface_share * static_cast<double>(frame.samples.size());
    const PatchMatch& match = surface.match();
    if (match.matched < needed || match.matched < 0.7 * match.visible) return std::nullopt;
    Track track;
    track.alignment = surface.result();
    track.tried = match.visible;
    track.inliers = match.matched;
    track.degenerate = is_degenerate(track.alignment.information, guess);
    track.guess_information = guess.information;
    return track;
}

Guess coarse_guess(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                   const Guess& guess, const DenseReference& last, const Pose& keyframe_from_last) {
    Guess better = guess;
    Pose& pose = better.camera_from_keyframe;
    for (const DenseLevel& level : last.levels) {
        for (int i = 0; i < kCoarseSteps; ++i) {
            Alignment alignment = make_alignment(options, frame, guess);
            QuadraticTerm photometric =
                photometric_term(level, frame.pyramid, frame.camera->color, pose * keyframe_from_last);
            photometric.at = pose;
            alignment.quadratics.push_back(photometric);
            alignment.quadratics.push_back(match_patches(keyframe.patches, frame.camera->color, frame.samples,
                                                         pose, kCoarseGate, options.surface_weight)
                                               .term);
            const Pose next = align(alignment, pose, 2).camera_from_keyframe;
            const double step = twist_from_pose(next * pose.inverse()).norm();
            pose = next;
            if (step < kCoarseStep) break;
        }
    }
    return better;
}

}  // namespace planemap::odometry
