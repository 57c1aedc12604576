// SPDX-License-Identifier: BSD-3-Clause
#include "places/verification.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <random>
#include <utility>

#include "core/geometry/angle.hpp"
#include "core/geometry/covariance.hpp"
#include "core/geometry/rigid_fit.hpp"
#include "core/geometry/same_plane.hpp"
#include "places/comparison.hpp"

namespace planemap::places {

namespace {

constexpr double kPlaneAngle = radians(kSamePlane_deg);  // as the map merges planes (paper section 2.3)

constexpr int kMostLike = 8;         // features that one is compared with, where many are alike
constexpr int kLeastRival = 12;      // points that agree by chance are fewer
constexpr double kRivalShare = 0.5;  // of the points, within one pair of views: as good an explanation
constexpr double kWeakRival = 0.2;   // and between pairs, which see a place from better and from worse

/// One point seen by both.
struct PointPair {
    Eigen::Vector3d p_a, p_b;
    Eigen::Matrix3d covariance_a, covariance_b;
    double variance = 0;  ///< in the worst direction, of both
};

/// Uncertainty of a point: depth noise along its ray, pixel noise across it.
Eigen::Matrix3d point_covariance(const Eigen::Vector3d& p, const DepthNoise& noise,
                                 const VerificationOptions& options) {
    const Eigen::Vector3d ray = p.normalized();
    const double along = noise.sigma(p.z()), across = options.bearing_sigma * p.norm();
    return across * across * Eigen::Matrix3d::Identity() +
           std::max(0.0, along * along - across * across) * ray * ray.transpose();
}

/// The points of a match.
PointPair make_pair(const KeyframeView& a, const KeyframeView& b, const Match& match,
                    const VerificationOptions& options) {
    const Eigen::Vector3d &p_a = a.points[static_cast<std::size_t>(match.first)],
                          &p_b = b.points[static_cast<std::size_t>(match.second)];
    const auto worst = [&](const Eigen::Vector3d& p, const DepthNoise& noise) {
        return std::max(noise.sigma(p.z()), options.bearing_sigma * p.norm());
    };
    const double worst_a = worst(p_a, a.noise), worst_b = worst(p_b, b.noise);
    return {p_a, p_b, point_covariance(p_a, a.noise, options), point_covariance(p_b, b.noise, options),
            worst_a * worst_a + worst_b * worst_b};
}

/// Information of the difference of a pair in frame a.
Eigen::Matrix3d information(const PointPair& pair, const Pose& a_from_b) {
    const Eigen::Matrix3d r = a_from_b.linear();
    const Eigen::Matrix3d sum =
        pair.covariance_a + r * pair.covariance_b * r.transpose() + 1e-10 * Eigen::Matrix3d::Identity();
    return sum.inverse();
}

double squared_sigmas(const PointPair& pair, const Pose& a_from_b) {
    const Eigen::Vector3d error = pair.p_a - a_from_b * pair.p_b;
    return error.dot(information(pair, a_from_b) * error);
}

int count_inliers(const std::vector<PointPair>& pairs, const Pose& a_from_b) {
    return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const PointPair& pair) {
        return squared_sigmas(pair, a_from_b) < kInlierSigmas * kInlierSigmas;
    }));
}

/// Fast and generous: the noise of the worst direction counts in all.
int count_near(const std::vector<PointPair>& pairs, const Pose& a_from_b) {
    const Eigen::Matrix3d r = a_from_b.linear();
    const Eigen::Vector3d t = a_from_b.translation();
    return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const PointPair& pair) {
        return (pair.p_a - r * pair.p_b - t).squaredNorm() < kInlierSigmas * kInlierSigmas * pair.variance;
    }));
}

/// The rigid motion that maps three points onto three others.
Pose align_three(const std::array<const PointPair*, 3>& sample) {
    Eigen::Matrix3d a, b;
    for (int i = 0; i < 3; ++i) {
        a.col(i) = sample[static_cast<std::size_t>(i)]->p_a;
        b.col(i) = sample[static_cast<std::size_t>(i)]->p_b;
    }
    return rigid_fit(a, b);
}

/// True when the triangle has about the same sides in both views and they are long enough to tell a rotation.
bool is_sound_sample(const std::array<const PointPair*, 3>& sample, const KeyframeView& a,
                     const KeyframeView& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const PointPair &p = *sample[i], &q = *sample[(i + 1) % 3];
        const double length_a = (p.p_a - q.p_a).norm(), length_b = (p.p_b - q.p_b).norm();
        const double noise = worst_sigma(a, b, std::max({p.p_a.z(), q.p_a.z(), p.p_b.z(), q.p_b.z()}));
        if (std::min(length_a, length_b) < 0.1 || std::abs(length_a - length_b) > 0.02 + 4 * noise)
            return false;
    }
    return true;
}

struct Consensus {
    Pose a_from_b = Pose::Identity();
    int inliers = 0;  ///< by count_near()
};

Consensus ransac(const KeyframeView& a, const KeyframeView& b, const std::vector<PointPair>& pairs,
                 const VerificationOptions& options, std::uint64_t seed) {
    Consensus best;
    std::mt19937_64 engine(seed);
    std::uniform_int_distribution<std::size_t> pick(0, pairs.size() - 1);
    double needed = options.max_ransac_iterations;
    // A sample that is not sound costs little, so it counts little.
    for (int tries = 0, i = 0; i < needed && tries < 20 * options.max_ransac_iterations; ++tries) {
        const std::array<const PointPair*, 3> sample{&pairs[pick(engine)], &pairs[pick(engine)],
                                                     &pairs[pick(engine)]};
        if (!is_sound_sample(sample, a, b)) continue;
        ++i;
        const Pose a_from_b = align_three(sample);
        const int inliers = count_near(pairs, a_from_b);
        if (inliers <= best.inliers) continue;
        best = {a_from_b, inliers};
        const double share = inliers / static_cast<double>(pairs.size());
        const double miss = std::log(1 - std::min(0.999, share * share * share));
        needed = std::min<double>(options.max_ransac_iterations, std::max(30.0, std::log(1e-4) / miss));
    }
    return best;
}

/// Normal equations of the small motion x: a_from_b becomes a_from_b * pose_from_twist(x).
struct NormalEquations {
    Matrix6d information = Matrix6d::Zero();
    Twist gradient = Twist::Zero();
    double cost = 0;  ///< weighted squared sigmas
    double weight = 0;

    /// Adds an error (in sigmas) that becomes error + jacobian x, with the Cauchy weight of its size.
    template <int N>
    void add(const Eigen::Matrix<double, N, 1>& error, const Eigen::Matrix<double, N, 6>& jacobian) {
        const double w = 1 / (1 + error.squaredNorm() / (2.0 * N));
        information += w * jacobian.transpose() * jacobian;
        gradient += w * jacobian.transpose() * error;
        cost += w * error.squaredNorm();
        weight += w * N;
    }
};

void add_points(const std::vector<PointPair>& pairs, const Pose& a_from_b, NormalEquations& equations) {
    const Eigen::Matrix3d r = a_from_b.linear();
    for (const PointPair& pair : pairs) {
        const Eigen::LLT<Eigen::Matrix3d> cholesky(information(pair, a_from_b));
        const Eigen::Matrix3d w = cholesky.matrixU();
        const Eigen::Vector3d error = w * (pair.p_a - a_from_b * pair.p_b);
        if (error.squaredNorm() > kInlierSigmas * kInlierSigmas * 4) continue;
        Eigen::Matrix<double, 3, 6> jacobian;
        jacobian << -w * r, w * r * skew(pair.p_b);
        equations.add<3>(error, jacobian);
    }
}

/// Two regions that are one plane for all that a pose not yet refined can tell: cheaper and looser in
/// distance than map/merging's rules, and asked again after each step.
struct PlanePair {
    const PlanarRegion *a, *b;
};

std::vector<PlanePair> pair_planes(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b) {
    std::vector<PlanePair> pairs;
    for (const PlanarRegion& region_b : b.regions) {
        const Plane plane = a_from_b * region_b.plane;
        const Box box = a_from_b * region_b.box;
        for (const PlanarRegion& region_a : a.regions) {
            if (angle_between(plane.normal, region_a.plane.normal) > kPlaneAngle) continue;
            if (std::abs(region_a.plane.signed_distance(box.frame_from_box.translation())) >
                2 * kPlaneDistance)
                continue;
            if (distance(region_a.box, box) > kPlaneDistance) continue;
            pairs.push_back({&region_a, &region_b});
        }
    }
    return pairs;
}

/// The centre of b's region lies on a's plane, and the normals agree. What a's plane says far from its own
/// region counts less.
void add_planes(const KeyframeView& a, const KeyframeView& b, const std::vector<PlanePair>& pairs,
                const Pose& a_from_b, NormalEquations& equations) {
    constexpr double kNormalSigma = 0.01;  // radians: what a sensor's distortion leaves
    const Eigen::Matrix3d r = a_from_b.linear();
    for (const PlanePair& pair : pairs) {
        const Plane &plane_a = pair.a->plane, &plane_b = pair.b->plane;
        const Eigen::Vector3d centre_b = pair.b->box.frame_from_box.translation();
        const Eigen::Vector3d centre = a_from_b * centre_b;
        const double reach = (centre - pair.a->box.frame_from_box.translation()).norm();
        const double sigma = 0.003 +
                             0.5 * worst_sigma(a, b, std::max(std::abs(centre.z()), std::abs(centre_b.z()))) +
                             kNormalSigma * reach;
        const Eigen::Vector3d u = plane_a.normal.unitOrthogonal(), v = plane_a.normal.cross(u);
        Eigen::Matrix<double, 2, 3> across;
        across << u.transpose(), v.transpose();
        Eigen::Vector3d error;
        error << across * (plane_a.normal - r * plane_b.normal) / kNormalSigma,
            plane_a.signed_distance(centre) / sigma;
        Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
        jacobian.topRightCorner<2, 3>() = across * r * skew(plane_b.normal) / kNormalSigma;
        jacobian.bottomRows<1>() << plane_a.normal.transpose() * r / sigma,
            -plane_a.normal.transpose() * r * skew(centre_b) / sigma;
        equations.add<3>(error, jacobian);
    }
}

struct Refined {
    Pose a_from_b = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();
    int planes = 0;
    bool determined = false;
};

Refined refine(const KeyframeView& a, const KeyframeView& b, const std::vector<PointPair>& pairs,
               Pose a_from_b) {
    Refined refined;
    for (int i = 0; i < 10; ++i) {
        const std::vector<PlanePair> planes = pair_planes(a, b, a_from_b);
        NormalEquations equations;
        add_points(pairs, a_from_b, equations);
        add_planes(a, b, planes, a_from_b, equations);
        const Eigen::LDLT<Matrix6d> solver(equations.information);
        const Twist step = solver.solve(-equations.gradient);
        refined.determined = solver.info() == Eigen::Success && solver.isPositive() && step.allFinite();
        if (!refined.determined) return refined;
        a_from_b = orthonormalised(a_from_b * pose_from_twist(step));
        refined.a_from_b = a_from_b;
        refined.planes = static_cast<int>(planes.size());
        const double excess = std::max(1.0, equations.cost / std::max(1.0, equations.weight));
        refined.covariance = solver.solve(Matrix6d::Identity()) * excess;
        if (step.norm() < 1e-6) break;
    }
    return refined;
}

std::vector<PointPair> make_pairs(const KeyframeView& a, const KeyframeView& b,
                                  const std::vector<Match>& matches, const VerificationOptions& options) {
    std::vector<PointPair> pairs;
    pairs.reserve(matches.size());
    for (const Match& match : matches) pairs.push_back(make_pair(a, b, match, options));
    return pairs;
}

/// How many cells of a 4 by 4 grid over the view's directions the points fall into.
int occupied_cells(const KeyframeView& view, const std::vector<Eigen::Vector3d>& points) {
    std::bitset<16> cells;
    const auto cell = [](double at) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, 3));
    };
    const Eigen::Vector2d span = (view.high - view.low).cwiseMax(1e-9);
    for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector2d at = (p.head<2>() / p.z() - view.low).cwiseQuotient(span) * 4;
        cells.set(4 * cell(at.y()) + cell(at.x()));
    }
    return static_cast<int>(cells.count());
}

bool spread_suffices(const KeyframeView& a, const KeyframeView& b, const std::vector<PointPair>& inliers,
                     const Refined& refined, const VerificationOptions& options) {
    if (largest_sigma(refined.covariance.topLeftCorner<3, 3>()) > options.max_sigma_m) return false;
    if (largest_sigma(refined.covariance.bottomRightCorner<3, 3>()) > options.max_sigma_rad) return false;
    std::vector<Eigen::Vector3d> in_a, in_b;
    for (const PointPair& pair : inliers) {
        in_a.push_back(pair.p_a);
        in_b.push_back(pair.p_b);
    }
    return occupied_cells(a, in_a) >= options.min_cells && occupied_cells(b, in_b) >= options.min_cells;
}

/// Inliers, as a share of the points of one view that the other should see: the smaller of both ways.
double visible_ratio(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b, int inliers) {
    const double in_a = overlap(a, b, a_from_b) * static_cast<double>(b.points.size());
    const double in_b =
        overlap(b, a, a_from_b.inverse(Eigen::Isometry)) * static_cast<double>(a.points.size());
    return inliers / std::max({in_a, in_b, 1.0});
}

/// How many points of b have a partner among the pairs under a pose.
int explained(const std::vector<Match>& matches, const std::vector<PointPair>& pairs, const Pose& a_from_b) {
    const Eigen::Matrix3d r = a_from_b.linear();
    const Eigen::Vector3d t = a_from_b.translation();
    int count = 0, last = -1;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const PointPair& pair = pairs[i];
        if (matches[i].second == last) continue;
        if ((pair.p_a - r * pair.p_b - t).squaredNorm() >= kInlierSigmas * kInlierSigmas * pair.variance)
            continue;
        last = matches[i].second;
        ++count;
    }
    return count;
}

/// Points of b among matches: no pose explains more.
int explained_at_most(const std::vector<Match>& matches) {
    int count = 0, last = -1;
    for (const Match& match : matches) count += std::exchange(last, match.second) != match.second;
    return count;
}

/// Whether what two views share fits another motion about as well. Asked of all pairs of like features, since
/// of a pattern that comes again the nearest descriptor is any.
bool is_ambiguous(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                  const VerificationOptions& options, std::uint64_t seed) {
    std::vector<Match> matches =
        match_all(a.descriptors, b.descriptors, options.matching.max_distance, kMostLike);
    std::vector<PointPair> pairs = make_pairs(a, b, matches, options);
    const int needed =
        std::max(kLeastRival, static_cast<int>(kRivalShare * explained(matches, pairs, a_from_b)));
    std::vector<Match> other_matches;
    std::vector<PointPair> others;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if ((pairs[i].p_a - a_from_b * pairs[i].p_b).norm() < kApart_m / 2) continue;
        other_matches.push_back(matches[i]);
        others.push_back(pairs[i]);
    }
    if (explained_at_most(other_matches) < needed) return false;
    const Consensus rival = ransac(a, b, others, options, seed);
    if (rival.inliers < needed || !are_apart(rival.a_from_b, a_from_b)) return false;
    if (explained(other_matches, others, rival.a_from_b) < needed) return false;
    const PlaneAgreement planes = compare_planes(a, b, rival.a_from_b);
    return planes.contradict <= options.max_contradiction * (planes.agree + planes.contradict);
}

}  // namespace

bool are_apart(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm() > kApart_m ||
           rotation_angle(a.inverse(Eigen::Isometry) * b) > kApart_rad;
}

VerificationOptions rival_options(const VerificationOptions& options, const Verification& found) {
    VerificationOptions rival = options;
    rival.min_inliers =
        std::min(options.min_inliers, std::max(kLeastRival, static_cast<int>(kWeakRival * found.inliers)));
    rival.min_inlier_ratio = 0.5 * options.min_inlier_ratio;
    rival.min_visible_ratio = 0.5 * options.min_visible_ratio;
    rival.min_cells = std::min(2, options.min_cells);
    rival.max_sigma_m = 3 * options.max_sigma_m;
    rival.max_sigma_rad = 3 * options.max_sigma_rad;
    rival.must_be_unique = false;
    return rival;
}

Verification verify(const KeyframeView& a, const KeyframeView& b, const VerificationOptions& options,
                    std::uint64_t seed) {
    Verification result;
    const std::vector<PointPair> pairs =
        make_pairs(a, b, match(a.descriptors, b.descriptors, options.matching), options);
    result.matches = static_cast<int>(pairs.size());
    if (result.matches < std::max(3, options.min_inliers)) return result;

    result.verdict = Verdict::kFewInliers;
    const Consensus consensus = ransac(a, b, pairs, options, seed);
    const int needed =
        std::max(options.min_inliers, static_cast<int>(options.min_inlier_ratio * result.matches));
    if (2 * consensus.inliers < needed) return result;  // refinement may double them, not more
    Refined refined = refine(a, b, pairs, consensus.a_from_b);
    if (!refined.determined) return result;
    result.inliers = count_inliers(pairs, refined.a_from_b);
    if (result.inliers < needed) return result;

    std::vector<PointPair> more = make_pairs(a, b, match_at(a, b, refined.a_from_b, options), options);
    refined = refine(a, b, more, refined.a_from_b);
    if (!refined.determined) return result;
    std::erase_if(more, [&](const PointPair& pair) {
        return squared_sigmas(pair, refined.a_from_b) >= kInlierSigmas * kInlierSigmas;
    });
    result.a_from_b = refined.a_from_b;
    result.covariance = refined.covariance;
    result.planes = refined.planes;
    result.inliers = static_cast<int>(more.size());

    result.verdict = Verdict::kFewOfVisible;
    if (visible_ratio(a, b, result.a_from_b, result.inliers) < options.min_visible_ratio) return result;
    result.verdict = Verdict::kBadSpread;
    if (!spread_suffices(a, b, more, refined, options)) return result;
    result.verdict = Verdict::kContradiction;
    const PlaneAgreement planes = compare_planes(a, b, result.a_from_b);
    if (planes.contradict > options.max_contradiction * (planes.agree + planes.contradict)) return result;
    result.verdict = Verdict::kAmbiguous;
    if (options.must_be_unique && is_ambiguous(a, b, result.a_from_b, options, seed)) return result;
    result.verdict = Verdict::kAccepted;
    return result;
}

}  // namespace planemap::places
