// SPDX-License-Identifier: BSD-3-Clause
// A program of its own, as it replaces operator new to count: segmentation allocates nothing once it is warm.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <random>
#include <utility>
#include <vector>

#include "segmentation/cells.hpp"
#include "segmentation/scene.hpp"

namespace {

std::atomic<long> allocations = 0;

void* allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment, size > 0 ? size : 1) != 0) throw std::bad_alloc();
    return memory;
}

}  // namespace

// Not inlined: else the compiler sees free() of what it takes for another operator new's.
[[gnu::noinline]] void* operator new(std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace planemap::segmentation {
namespace {

/// One wall; a corner; a wall with 20 holes; steps; few planes with dust; nothing. Their regions, rings and
/// candidates differ in number.
std::vector<DepthImage> frames(const CameraInfo& camera) {
    const Plane wall = scene::tilted(0.1, 0.2, {0, 0, 2});
    const Plane left = scene::tilted(0.1, 0.8, {0, 0, 2.5}), right = scene::tilted(0.1, -0.7, {0, 0, 2.5});
    std::vector<DepthImage> all;
    all.push_back(scene::render(camera, {scene::plane(wall)}, true));
    all.push_back(scene::render(camera, {scene::plane(left), scene::plane(right)}, true));
    all.push_back(all[0]);
    for (int v = 0; v < camera.depth.height; ++v) {
        for (int u = 0; u < camera.depth.width; ++u) {
            if (u / 30 % 2 == 1 && v / 30 % 2 == 1) all[2](u, v) = 0;
        }
    }
    std::vector<scene::Surface> steps;
    for (int k = 0; k < 6; ++k) {
        steps.push_back(scene::plane(scene::tilted(0, 0, {0, 0, 1.2 + 0.1 * k}), [k](const auto& p) {
            return std::abs(p.x() / p.z() - 0.18 * (k - 2.5)) < 0.09;
        }));
    }
    all.push_back(scene::render(camera, steps, true));
    all.push_back(all[1]);
    std::mt19937_64 random(2);
    for (std::uint16_t& raw : all.back().pixels) {
        if (random() % 10 == 0) raw = static_cast<std::uint16_t>(random());
    }
    all.emplace_back(camera.depth.width, camera.depth.height);
    return all;
}

class Allocations : public testing::TestWithParam<std::pair<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Sizes, Allocations,
                         testing::Values(std::pair{640, 480}, std::pair{321, 243}, std::pair{40, 40}));

TEST_P(Allocations, NoneOnceWarm) {
    CameraInfo camera = scene::camera(GetParam().first, GetParam().second);
    camera.serial = "a serial number that does not fit in a short string";
    const std::vector<DepthImage> images = frames(camera);
    const auto segmenter = make_cell_segmenter(CellOptions{});
    Segmentation out;
    std::size_t regions = 0;
    for (int round = 0; round < 4; ++round) {
        for (const DepthImage& image : images) {
            segmenter->segment(image, camera, out);
            regions += out.regions.size();
        }
    }
    EXPECT_GT(regions, 4u);
    for (int round = 0; round < 10; ++round) {
        for (std::size_t i = 0; i < images.size(); ++i) {
            const long before = allocations;
            segmenter->segment(images[i], camera, out);
            EXPECT_EQ(allocations - before, 0) << "round " << round << ", frame " << i;
        }
    }
}

TEST(AllocationTest, TheCounterCounts) {
    const long before = allocations;
    void *memory = ::operator new(100), *aligned = ::operator new (100, std::align_val_t{64});
    EXPECT_EQ(allocations - before, 2);
    ::operator delete (aligned, std::align_val_t{64});
    ::operator delete(memory);
}

}  // namespace
}  // namespace planemap::segmentation
