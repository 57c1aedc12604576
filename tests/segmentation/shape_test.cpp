// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "core/trace.hpp"
#include "segmentation/outline_reach.hpp"
#include "segmentation/scene.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {
namespace {

/// A region whose pixels, all exactly on the plane, are those of label 1.
struct Labelled {
    Labelled(const Plane& plane, const std::function<bool(int, int)>& holds, int width = 640,
             int height = 480)
        : camera(scene::camera(width, height)), labels(width, height), regions(1) {
        camera.depth_units_per_metre = 10000;
        const DepthImage depth = scene::render(camera, {scene::plane(plane)});
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < width; ++u) {
                if (!holds(u, v)) continue;
                labels(u, v) = 1;
                const double z = camera.metres(depth(u, v));
                points.push_back(camera.depth.unproject(u, v, z));
                regions[0].moments.add(points.back());
                // A pixel's share of the plane: its solid angle's footprint.
                const Eigen::Vector3d ray = camera.depth.unproject(u, v, 1);
                true_area += z * z / (camera.depth.fx * camera.depth.fy) / std::abs(plane.normal.dot(ray));
            }
        }
        regions[0].plane = plane;
        ShapeTracer().trace_all(depth, labels, camera, regions);
    }

    double share_inside_outline() const {
        const Pose box_from_camera = regions[0].box.frame_from_box.inverse();
        double inside = 0;
        for (const auto& p : points) inside += contains(regions[0].outline, (box_from_camera * p).head<2>());
        return inside / static_cast<double>(points.size());
    }
    double share_inside_box() const {
        const Pose box_from_camera = regions[0].box.frame_from_box.inverse();
        double inside = 0;
        for (const auto& p : points) {
            const Eigen::Vector2d q = (box_from_camera * p).head<2>().cwiseAbs();
            inside += (q.array() <= regions[0].box.half_extents.head<2>().array()).all();
        }
        return inside / static_cast<double>(points.size());
    }

    CameraInfo camera;
    Image<std::uint16_t> labels;
    std::vector<PlanarRegion> regions;
    std::vector<Eigen::Vector3d> points;
    double true_area = 0;
};

void expect_close_fit(const Labelled& l) {
    ASSERT_TRUE(is_valid(l.regions[0]));
    EXPECT_NEAR(area(l.regions[0].outline), l.true_area, 0.03 * l.true_area);
    EXPECT_GT(l.share_inside_outline(), 0.98);
    EXPECT_GT(l.share_inside_box(), 0.98);
}

const Plane kSlanted = scene::tilted(0.3, 0.5, {0, 0, 2});

TEST(ShapeTest, WholeImage) {
    expect_close_fit({kSlanted, [](int, int) { return true; }});
}

TEST(ShapeTest, Disc) {
    const Labelled disc(kSlanted, [](int u, int v) { return std::hypot(u - 300, v - 200) < 120; });
    expect_close_fit(disc);
    ASSERT_EQ(disc.regions[0].outline.rings.size(), 1u);
    EXPECT_GT(signed_area(disc.regions[0].outline.rings[0]), 0);  // counter-clockwise about the normal
    EXPECT_LT(disc.regions[0].outline.vertex_count(), 100u);
}

TEST(ShapeTest, RingHasAHole) {
    const Labelled ring(kSlanted, [](int u, int v) {
        const double r = std::hypot(u - 300, v - 200);
        return r > 60 && r < 150;
    });
    expect_close_fit(ring);
    EXPECT_EQ(ring.regions[0].outline.rings.size(), 2u);
}

TEST(ShapeTest, SeparateParts) {
    const Labelled parts(kSlanted, [](int u, int) { return u % 100 < 60; });
    expect_close_fit(parts);
    EXPECT_GE(parts.regions[0].outline.rings.size(), 6u);
}

TEST(ShapeTest, OddSizes) {
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{{641, 479}, {1280, 720}, {333, 77}}) {
        expect_close_fit({kSlanted,
                          [w = width, h = height](int u, int v) { return u > w / 4 && v < h * 3 / 4; }, width,
                          height});
    }
}

TEST(ShapeTest, LongAxisOfTheBoxIsTheRegions) {
    const Labelled bar(scene::tilted(0, 0, {0, 0, 2}),
                       [](int u, int v) { return std::abs(u - v - 60) < 20; });
    EXPECT_NEAR(std::abs(bar.regions[0].box.frame_from_box.linear().col(0).dot(
                    Eigen::Vector3d(1, 1, 0).normalized())),
                1, 0.01);
    EXPECT_GT(bar.regions[0].box.half_extents.x(), 5 * bar.regions[0].box.half_extents.y());
}

TEST(ShapeTest, ScatteredPixelsDoNotMakeAnInvalidRegion) {
    std::mt19937_64 random(3);
    std::bernoulli_distribution coin(0.3);
    const Labelled dust(
        kSlanted, [&](int, int) { return coin(random); }, 100, 80);
    EXPECT_TRUE(is_valid(dust.regions[0]));
    const Labelled few(kSlanted, [](int u, int v) { return u == 600 && v % 100 == 3; });
    EXPECT_TRUE(is_valid(few.regions[0]));
    EXPECT_TRUE(few.regions[0].outline.empty());
}

TEST(ShapeTest, CornersBeyondTheHorizonAreNoFartherThanReadings) {
    CameraInfo camera = scene::camera(64, 48);
    camera.depth_max_m = 1e308;
    std::vector<PlanarRegion> regions(1);
    regions[0].plane = {{0, -1, 0}, 1};  // a floor, which the upper half of the image does not see
    for (const double x : {-1, 0, 1}) {
        for (const double z : {2, 3}) regions[0].moments.add({x, 1, z});
    }
    ShapeTracer().trace_all(DepthImage(64, 48, 3000), Image<std::uint16_t>(64, 48, 1), camera, regions);
    EXPECT_TRUE(is_valid(regions[0]));
    EXPECT_LT(regions[0].box.half_extents.maxCoeff(), 2 * 65.5);
}

/// A camera, and regions of one plane that lack box and outline, for a label image.
struct Traced {
    Traced(ShapeTracer& tracer, const Image<std::uint16_t>& labels)
        : camera(scene::camera(labels.width, labels.height)),
          regions(*std::max_element(labels.pixels.begin(), labels.pixels.end())) {
        for (int v = 0; v < labels.height; ++v) {
            for (int u = 0; u < labels.width; ++u) {
                if (labels(u, v) == 0) continue;
                const Eigen::Vector3d ray = camera.depth.unproject(u, v, 1);
                regions[labels(u, v) - 1u].moments.add(ray * (-kSlanted.d / kSlanted.normal.dot(ray)));
            }
        }
        for (PlanarRegion& region : regions) region.plane = kSlanted;
        tracer.trace_all(scene::render(camera, {scene::plane(kSlanted)}), labels, camera, regions);
    }
    /// A region's outline in blocks of so many pixels.
    Outline in_blocks(std::size_t region, double block_px) const {
        Outline outline = regions[region].outline;
        for (Ring& ring : outline.rings) {
            for (Eigen::Vector2d& v : ring) {
                const Eigen::Vector3d p =
                    regions[region].box.frame_from_box * Eigen::Vector3d(v.x(), v.y(), 0);
                v = (camera.depth.project(p).array() + 0.5) / block_px;
            }
        }
        return outline;
    }

    CameraInfo camera;
    std::vector<PlanarRegion> regions;
};

/// True when edges of the outline meet elsewhere than at the vertex that they share.
bool crosses_itself(const Outline& outline) {
    struct Edge {
        Eigen::Vector2d a, b;
    };
    std::vector<Edge> edges;
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
    const auto side = [](const Edge& e, const Eigen::Vector2d& p) {
        const Eigen::Vector2d along = e.b - e.a, to = p - e.a;
        return along.x() * to.y() - along.y() * to.x();
    };
    constexpr double kTouch = 1e-9;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Edge &e = edges[i], &f = edges[j];
            if (e.a == f.b || e.b == f.a) continue;
            if (side(e, f.a) * side(e, f.b) < kTouch && side(f, e.a) * side(f, e.b) < kTouch) {
                // On one line they meet only if their boxes do.
                const auto apart = [&](int k) {
                    return std::max(e.a[k], e.b[k]) < std::min(f.a[k], f.b[k]) - kTouch ||
                           std::max(f.a[k], f.b[k]) < std::min(e.a[k], e.b[k]) - kTouch;
                };
                if (!apart(0) && !apart(1)) return true;
            }
        }
    }
    return false;
}

TEST(ShapeTest, OutlinesHoldTheVeryBlocksThatTraceDoes) {
    // Where a block is one pixel: dust, holes, corners that touch; coarse patches; a comb of thin lines.
    std::mt19937_64 random(9);
    ShapeTracer tracer;  // the same for all, with what it remembers
    for (int trial = 0; trial < 60; ++trial) {
        const auto pick = [&](int low, int high) {
            return std::uniform_int_distribution<int>(low, high)(random);
        };
        // No higher than wide: the field of view is 60 degrees across, and all rays are to meet the plane.
        const int width = pick(3, 50), height = pick(3, width), kinds = pick(1, 4),
                  grain = trial % 3 == 0 ? pick(2, 6) : 1;
        std::bernoulli_distribution labelled(std::uniform_real_distribution<double>(0.2, 0.95)(random));
        Image<std::uint16_t> labels(width, height);
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < width; ++u) {
                if (u % grain != 0) {
                    labels(u, v) = labels(u - 1, v);
                } else if (v % grain != 0) {
                    labels(u, v) = labels(u, v - 1);
                } else {
                    labels(u, v) = static_cast<std::uint16_t>(labelled(random) ? pick(1, kinds) : 0);
                }
            }
        }
        const Traced traced(tracer, labels);
        for (std::size_t r = 0; r < traced.regions.size(); ++r) {
            Mask mask(width, height), filled(width, height);
            int blocks = 0;
            for (int v = 0; v < height; ++v) {
                for (int u = 0; u < width; ++u) {
                    if (labels(u, v) == r + 1) mask.set(u, v), ++blocks;
                }
            }
            const Outline expected = test::trace(mask), outline = traced.in_blocks(r, 1);
            fill(outline, filled);
            EXPECT_EQ(filled.cells, mask.cells) << trial;
            ASSERT_EQ(outline.rings.size(), expected.rings.size()) << trial;
            EXPECT_FALSE(crosses_itself(outline)) << trial;
            // Every ring has the direction of one of trace()'s; in the image's axes y grows downwards, and
            // so does its y. A corner cut off costs 1/8; a ring has four more that cut than that fill up.
            double area_of_rings = 0, expected_area = 0, slack = 0;
            int outer = 0, expected_outer = 0;
            for (const Ring& ring : outline.rings) {
                area_of_rings += signed_area(ring);
                outer += signed_area(ring) < 0 ? 1 : -1;
                for (std::size_t i = 0; i < ring.size(); ++i)
                    slack += 0.35 * (ring[i] - ring[(i + 1) % ring.size()]).norm();
            }
            for (const Ring& ring : expected.rings) {
                expected_area += signed_area(ring);
                expected_outer += signed_area(ring) > 0 ? 1 : -1;
            }
            EXPECT_EQ(outer, expected_outer) << trial;
            EXPECT_EQ(expected_area, blocks);
            EXPECT_NEAR(-area_of_rings, blocks - 0.5 * outer, slack + 1e-6) << trial;
            EXPECT_NEAR(area(outline), -area_of_rings, 1e-6) << trial;
        }
    }
}

TEST(ShapeTest, LargerBlocksAreWhatMostOfTheirPixelsAre) {
    std::mt19937_64 random(4);
    ShapeTracer tracer;
    for (const auto& [width, height, block] :
         std::vector<std::array<int, 3>>{{320, 60, 2}, {480, 60, 3}, {640, 64, 4}, {1280, 64, 8}}) {
        // Patches of two blocks, jittered, with dust.
        Image<std::uint16_t> labels(width, height);
        const auto patch_label = [size = 2 * block](int u, int v) {
            return (u / size * 7 + v / size * 3) % 4;
        };
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < width; ++u) {
                const bool dust = random() % 5 == 0;
                labels(u, v) = static_cast<std::uint16_t>(dust ? random() % 4 : patch_label(u + 1, v));
            }
        }
        const Traced traced(tracer, labels);
        ASSERT_EQ(traced.regions.size(), 3u);
        for (std::size_t r = 0; r < 3; ++r) {
            Mask expected(width / block, height / block), filled(width / block, height / block);
            for (int y = 0; y < expected.height; ++y) {
                for (int x = 0; x < expected.width; ++x) {
                    int count = 0;
                    for (int k = 0; k < block * block; ++k)
                        count += labels(x * block + k % block, y * block + k / block) == r + 1;
                    if (2 * count > block * block) expected.set(x, y);
                }
            }
            fill(traced.in_blocks(r, block), filled);
            EXPECT_EQ(filled.cells, expected.cells) << block;
        }
    }
}

TEST(ShapeTest, RecycledMemoryChangesNothing) {
    const auto label_image = [](int kind) {
        Image<std::uint16_t> labels(160, 120);
        for (int v = 0; v < 120; ++v) {
            for (int u = 0; u < 160; ++u)
                labels(u, v) = static_cast<std::uint16_t>((u / (5 + kind) + v / (9 - kind)) % (2 + kind));
        }
        return labels;
    };
    ShapeTracer used;
    std::vector<PlanarRegion> previous;
    for (int round = 0; round < 3; ++round) {
        for (int kind = 0; kind < 4; ++kind) {
            used.recycle(previous);
            const Traced again(used, label_image(kind));
            ShapeTracer fresh;
            const Traced first(fresh, label_image(kind));
            ASSERT_EQ(again.regions.size(), first.regions.size());
            for (std::size_t r = 0; r < first.regions.size(); ++r)
                EXPECT_EQ(again.regions[r].outline.rings, first.regions[r].outline.rings);
            previous = again.regions;
        }
    }
}

TEST(ShapeTest, OutlinesDoNotReachBeyondReadings) {
    std::mt19937_64 random(11);
    const auto pick = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const std::unique_ptr<Segmenter> segmenter = make_segmenter({});
    int vertices = 0, crossing = 0;
    for (int trial = 0; trial < 40; ++trial) {
        CameraInfo camera = scene::camera(trial % 2 == 0 ? 320 : 640, trial % 2 == 0 ? 240 : 480);
        camera.depth_max_m = pick(2, 9);  // cuts the floor off, wherever it is seen at a grazing angle
        const double pitch = pick(-0.15, 0.3), roll = pick(-0.3, 0.3);
        const Eigen::Matrix3d turn = so3_exp({pitch, 0, 0}) * so3_exp({0, 0, roll});
        const Plane floor{turn * Eigen::Vector3d(0, -1, 0), pick(0.1, 1.5)};
        const Plane wall = scene::tilted(pick(-0.3, 0.3), pick(-1.4, 1.4), {0, 0, pick(1, 7)});
        const Eigen::Vector2d post(pick(-1, 1), pick(1, 3));
        const DepthImage depth = scene::render(
            camera, {scene::plane(floor), scene::plane(wall), scene::cylinder(post.x(), post.y(), 0.05)},
            trial % 4 != 0, static_cast<std::uint64_t>(trial + 1));
        Segmentation segmentation;
        segmenter->segment(depth, camera, segmentation);
        const Reach reach = reach_of(segmentation, depth, camera);
        EXPECT_LE(reach.worst, 1) << trial;
        vertices += reach.vertices;
        crossing += reach.crossing;
    }
    EXPECT_GT(vertices, 1000);
    EXPECT_EQ(crossing, 0);
}

TEST(DepthRangeTest, KeepsWithin16BitsAndOffInvalidValues) {
    CameraInfo camera = scene::camera(8, 8);
    camera.depth_min_m = 0;
    camera.depth_max_m = 1000;
    const DepthRange all(camera);
    EXPECT_FALSE(all.contains(0));
    EXPECT_TRUE(all.contains(1));
    EXPECT_TRUE(all.contains(65534));
    EXPECT_FALSE(all.contains(65535));
    camera.depth_min_m = 0.5;
    camera.depth_max_m = 4;
    const DepthRange some(camera);
    EXPECT_FALSE(some.contains(499));
    EXPECT_TRUE(some.contains(500));
    EXPECT_TRUE(some.contains(4000));
    EXPECT_FALSE(some.contains(4001));
}

TEST(DepthRangeTest, UnitsOfAnySize) {
    CameraInfo camera = scene::camera(8, 8);
    for (const double units : {1e-300, 1e-3, 0.1, 1e5, 1e300}) {
        camera.depth_units_per_metre = units;
        const DepthRange range(camera);
        for (const int raw : {0, 1, 1000, 65534, 65535}) {
            EXPECT_EQ(
                range.contains(static_cast<std::uint16_t>(raw)),
                is_valid_depth(static_cast<std::uint16_t>(raw)) && raw / units >= 0.3 && raw / units <= 8)
                << units << " " << raw;
        }
    }
    camera.depth_units_per_metre = 1000;
    camera.depth_min_m = 0.5004;  // between two readings
    camera.depth_max_m = 0.5006;
    const DepthRange none(camera);
    for (int raw = 0; raw < 65536; ++raw) ASSERT_FALSE(none.contains(static_cast<std::uint16_t>(raw)));
}

}  // namespace
}  // namespace planemap::segmentation
