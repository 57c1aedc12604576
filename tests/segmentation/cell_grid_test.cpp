// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "segmentation/scene.hpp"
#include "segmentation/shape.hpp"

namespace planemap::segmentation {
namespace {

/// A tilted noisy plane with a step in it and holes.
DepthImage noisy_depth(int width, int height, double invalid_share) {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<int> noise(-4, 4);
    std::bernoulli_distribution invalid(invalid_share);
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            const int z = 1500 + u + 2 * v + (u > width / 2 ? 700 : 0) + noise(random);
            depth(u, v) = static_cast<std::uint16_t>(invalid(random) ? (u % 2 == 0 ? 0 : 65535) : z);
        }
    }
    return depth;
}

CellRules rules_for(const CameraInfo& camera) {
    CellRules rules = sensor_rules(camera);
    rules.min_pixels = 10;
    rules.planarity_sigmas = 3;
    rules.grow_m = 0.01;
    rules.grow_sigmas = 1.5;
    rules.grow_angle_rad = 0.25;
    return rules;
}

PointSums brute_force(const DepthImage& depth, const CameraInfo& camera, int u0, int v0) {
    PointSums s;
    for (int v = v0; v < std::min(v0 + kCellPx, depth.height); ++v) {
        for (int u = u0; u < std::min(u0 + kCellPx, depth.width); ++u) {
            if (!is_valid_depth(depth(u, v))) continue;
            const Eigen::Vector3d p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
            s += {1,
                  p.x(),
                  p.y(),
                  p.z(),
                  p.x() * p.x(),
                  p.x() * p.y(),
                  p.x() * p.z(),
                  p.y() * p.y(),
                  p.y() * p.z(),
                  p.z() * p.z()};
        }
    }
    return s;
}

void expect_near(const PointSums& a, const PointSums& b) {
    EXPECT_EQ(a.n, b.n);
    const double tolerance = 1e-7 * (1 + b.zz);
    for (const auto field : {&PointSums::x, &PointSums::y, &PointSums::z, &PointSums::xx, &PointSums::xy,
                             &PointSums::xz, &PointSums::yy, &PointSums::yz, &PointSums::zz})
        EXPECT_NEAR(a.*field, b.*field, tolerance);
}

/// All the kernels that this machine runs.
class Kernels : public testing::TestWithParam<const CellKernels*> {};
std::vector<const CellKernels*> kernels() {
    std::vector<const CellKernels*> all{&portable_cell_kernels(), &baseline_cell_kernels()};
    if (avx2_cell_kernels() != nullptr) all.push_back(avx2_cell_kernels());
    return all;
}
INSTANTIATE_TEST_SUITE_P(All, Kernels, testing::ValuesIn(kernels()),
                         [](const auto& info) { return std::string(info.param->name); });

TEST_P(Kernels, SumsAndFitsEqualBruteForce) {
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{{75, 51}, {128, 64}, {17, 3}}) {
        for (const double invalid : {0.0, 0.3}) {
            const CameraInfo camera = scene::camera(width, height);
            const DepthImage depth = noisy_depth(width, height, invalid);
            CellGrid grid(*GetParam());
            grid.reset(depth, rules_for(camera));
            grid.fit();
            double pixels = 0;
            int planar = 0;
            for (int cell = 0; cell < grid.size(); ++cell) {
                const PointSums expected = brute_force(depth, camera, cell % grid.columns() * kCellPx,
                                                       cell / grid.columns() * kCellPx);
                expect_near(grid.sums()[cell], expected);
                pixels += grid.sums()[cell].n;
                const Cell& fitted = grid.cells()[cell];
                if (!fitted.planar()) continue;
                ++planar;
                const InverseDepthFit fit = expected.fit();
                ASSERT_TRUE(fit.valid);
                EXPECT_NEAR(fitted.x, fit.x, 1e-6);
                EXPECT_NEAR(fitted.y, fit.y, 1e-6);
                EXPECT_NEAR(fitted.w, fit.w, 1e-6);
                EXPECT_NEAR(fitted.a, fit.plane.a, 1e-4);
                EXPECT_NEAR(fitted.b, fit.plane.b, 1e-4);
                EXPECT_NEAR(fitted.mse, fit.mse, 1e-3 * fit.mse + 1e-10);
                EXPECT_NEAR(fitted.xx, fit.xx, 1e-5 * fit.xx);
                EXPECT_EQ(fitted.pixels, expected.n);
                EXPECT_NEAR(fitted.yy, fit.yy, 1e-5 * fit.yy);
            }
            EXPECT_EQ(pixels, static_cast<double>(
                                  std::count_if(depth.pixels.begin(), depth.pixels.end(), is_valid_depth)));
            if (width > 17) {
                EXPECT_GT(planar, grid.size() / 2);
            }
        }
    }
}

TEST_P(Kernels, LabelsGoToTheNearestPlaneWithinTheBand) {
    const CameraInfo camera = scene::camera(75, 51);
    DepthImage depth(75, 51, 2000);
    for (int v = 0; v < 51; ++v) {
        for (int u = 0; u < 75; ++u)
            depth(u, v) = static_cast<std::uint16_t>(u % 5 == 0 ? 0 : 1950 + 30 * (u % 5));
    }  // 1980, 2010, 2040, 2070 and invalid
    CellGrid grid(*GetParam());
    grid.reset(depth, rules_for(camera));
    const std::vector<Candidate> planes{grid.candidate({0, 0, 1 / 1.99}, 3),
                                        grid.candidate({0, 0, 1 / 2.032}, 9)};
    const BorderBand band{0.025, 0, camera.noise};
    std::array<int, 2> total{};
    for (int cell = 0; cell < grid.size(); ++cell) {
        std::array<std::uint8_t, 2> counts{};
        grid.label(grid.place(cell), band, planes, counts.data());
        for (std::size_t k = 0; k < 2; ++k) total[k] += counts[k];
    }
    Image<std::uint16_t> labels;
    grid.take_labels(labels);
    ASSERT_EQ(labels.width, 75);
    ASSERT_EQ(labels.height, 51);
    for (int v = 0; v < 51; ++v) {
        for (int u = 0; u < 75; ++u) {
            constexpr std::array<int, 5> kExpected{0, 3, 3, 9, 0};
            EXPECT_EQ(labels(u, v), kExpected[u % 5]) << u << " " << v;
        }
    }
    EXPECT_EQ(total[0], 2 * 15 * 51);
    EXPECT_EQ(total[1], 15 * 51);
}

TEST_P(Kernels, BandWidensWithTheNoise) {
    const CameraInfo camera = scene::camera(64, 48);
    const DepthImage depth(64, 48, 4030);  // 3 cm behind the plane; 3 sigma are 7.7 cm there
    for (const double sigmas : {0.0, 3.0}) {
        CellGrid grid(*GetParam());
        grid.reset(depth, rules_for(camera));
        std::uint8_t pixels = 0;
        grid.label({0, 0}, {0.015, sigmas, camera.noise},
                   std::vector<Candidate>{grid.candidate({0, 0, 1 / 4.0}, 1)}, &pixels);
        EXPECT_EQ(pixels, sigmas > 0 ? 64 : 0);
    }
}

TEST_P(Kernels, SumsOfPartsEqualBruteForce) {
    const CameraInfo camera = scene::camera(75, 51);
    const DepthImage depth = noisy_depth(75, 51, 0.3);
    CellGrid grid(*GetParam());
    grid.reset(depth, rules_for(camera));
    grid.fit();
    // The band cuts the noisy plane in two; both parts are summed, in batches of all sizes up to eight.
    const std::vector<Candidate> planes{grid.candidate({0, 0, 1 / 1.55}, 1),
                                        grid.candidate({0, 0, 1 / 1.6}, 2)};
    std::vector<CellGrid::Part> parts;
    for (int cell = 0; cell < grid.size(); ++cell) {
        std::array<std::uint8_t, 2> counts{};
        grid.label(grid.place(cell), {0.03, 0, camera.noise}, planes, counts.data());
        if (counts[1] > 0) parts.push_back({grid.place(cell), 2, grid.depth_at(grid.place(cell), planes[1])});
    }
    std::array<PointSums, 8> sums;
    PointSums total;
    for (std::size_t k = 0, n = 1; k < parts.size(); k += n, n = n % 8 + 1) {
        const std::size_t count = std::min(n, parts.size() - k);
        grid.sum(std::span(parts).subspan(k, count), sums.data());
        for (std::size_t i = 0; i < count; ++i) total += sums[i];
    }
    Image<std::uint16_t> labels;
    grid.take_labels(labels);
    const Moments expected = scene::brute_force_moments(depth, camera, labels, 2);
    ASSERT_GT(expected.count, 100);
    EXPECT_EQ(total.n, expected.count);
    EXPECT_LT((total.moments().sum - expected.sum).norm(), 1e-8 * expected.sum.norm());
    EXPECT_LT((total.moments().scatter - expected.scatter).norm(), 1e-8 * expected.scatter.norm());
}

TEST_P(Kernels, GiveTheSameBits) {
    const CameraInfo camera = scene::camera(333, 207);
    const DepthImage depth = noisy_depth(333, 207, 0.1);
    CellGrid grid(*GetParam()), portable(portable_cell_kernels());
    grid.reset(depth, rules_for(camera));
    portable.reset(depth, rules_for(camera));
    grid.fit();
    portable.fit();
    ASSERT_EQ(grid.size(), portable.size());
    const auto bytes = static_cast<std::size_t>(grid.size());
    EXPECT_EQ(std::memcmp(grid.cells().data(), portable.cells().data(), bytes * sizeof(Cell)), 0);
    EXPECT_EQ(std::memcmp(grid.sums().data(), portable.sums().data(), bytes * sizeof(PointSums)), 0);
}

TEST_P(Kernels, AnEmptyRangeHoldsNothing) {
    const CameraInfo camera = scene::camera(64, 48);
    for (const auto& [low, high] : std::vector<std::pair<int, int>>{{1, 0}, {501, 500}, {65534, 1}}) {
        CellRules rules = rules_for(camera);
        rules.low = static_cast<std::uint16_t>(low);
        rules.high = static_cast<std::uint16_t>(high);
        for (const int raw : {0, 1, 499, 500, 501, 65534, 65535}) {
            const DepthImage depth(64, 48, static_cast<std::uint16_t>(raw));
            CellGrid grid(*GetParam());
            grid.reset(depth, rules);
            grid.fit();
            for (int cell = 0; cell < grid.size(); ++cell) {
                EXPECT_EQ(grid.sums()[cell].n, 0);
                EXPECT_FALSE(grid.cells()[cell].planar());
            }
            const double z = std::max(raw, 1) * 1e-3;
            std::vector<Candidate> planes{grid.candidate({0, 0, 1 / z}, 1)};
            for (int count = 1; count <= 2; ++count) {
                std::array<std::uint8_t, 2> pixels{};
                grid.label({0, 0}, {0.015, 3, camera.noise}, planes, pixels.data());
                EXPECT_EQ(pixels[0], 0) << low << " to " << high << ", " << raw;
                planes.push_back(grid.candidate({0, 0, 2 / z}, 2));
            }
        }
    }
}

TEST_P(Kernels, RangeIsInclusive) {
    const CameraInfo camera = scene::camera(64, 48);
    CellRules rules = rules_for(camera);
    rules.low = 500;
    rules.high = 600;
    for (const int raw : {499, 500, 600, 601}) {
        const DepthImage depth(64, 48, static_cast<std::uint16_t>(raw));
        CellGrid grid(*GetParam());
        grid.reset(depth, rules);
        grid.fit();
        const int expected = raw >= 500 && raw <= 600 ? 64 : 0;
        EXPECT_EQ(grid.sums()[0].n, expected) << raw;
        std::uint8_t pixels = 1;
        grid.label({0, 0}, {0.015, 3, camera.noise},
                   std::vector<Candidate>{grid.candidate({0, 0, 1000.0 / raw}, 1)}, &pixels);
        EXPECT_EQ(pixels, expected) << raw;
    }
}

TEST(CellGridTest, DepthOfAnyPlaneIsAReading) {
    const CameraInfo camera = scene::camera(64, 48);
    const DepthImage depth(64, 48, 1000);
    CellGrid grid(best_cell_kernels());
    grid.reset(depth, rules_for(camera));
    EXPECT_EQ(grid.depth_at({3, 2}, grid.candidate({0, 0, 1 / 1.5}, 1)), 1500);
    // Behind the camera, beyond all readings, not a number: anything that a reading can be.
    for (const double bad : {-1.0, 0.0, 1e-9, 1e9, 1e300, std::nan("")}) {
        EXPECT_LE(grid.depth_at({3, 2}, grid.candidate({bad, 0, bad}, 1)), 65534) << bad;
        EXPECT_LE(grid.depth_at({3, 2}, {bad, 0, 0, 1, 1}), 65534) << bad;
    }
}

TEST(CellGridTest, NothingValidIsNothingPlanar) {
    const CameraInfo camera = scene::camera(40, 30);
    const DepthImage depth(40, 30, 65535);
    CellGrid grid(best_cell_kernels());
    grid.reset(depth, rules_for(camera));
    grid.fit();
    for (int cell = 0; cell < grid.size(); ++cell) {
        EXPECT_EQ(grid.sums()[cell].n, 0);
        EXPECT_FALSE(grid.cells()[cell].planar());
    }
}

}  // namespace
}  // namespace planemap::segmentation
