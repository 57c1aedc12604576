// SPDX-License-Identifier: BSD-3-Clause
// Depth by time of flight, stereo and lidar: what they make of edges and bare walls, and noise.
#include "simulator/depth_reading.hpp"

namespace planemap::simulator {

namespace {

/// From here on two inverse depths are an edge.
constexpr float kEdge = 1.05f;

bool is_edge(float a, float b) {
    return std::max(a, b) > kEdge * std::min(a, b);
}

/// Random bits of a pixel, or of a patch of pixels.
std::uint64_t bits_of(std::uint64_t seed, int u, int v) {
    return mix(seed, static_cast<std::uint64_t>(v), static_cast<std::uint64_t>(u));
}

/// Time of flight: a pixel that sees two surfaces reads something between them. The sensor knows some of
/// these readings, and takes them out.
Image<float> with_flying_pixels(const View& view, std::uint64_t seed) {
    constexpr double kTakenOut = 0.35, kFlying = 0.8;
    Image<float> inverse = view.inverse_depth;
    for (int v = 0; v < inverse.height; ++v) {
        for (int u = 0; u < inverse.width; ++u) {
            const float own = view.inverse_depth(u, v);
            float other = own;
            constexpr int kSteps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
            for (const auto& [du, dv] : kSteps) {
                if (!inverse.contains(u + du, v + dv)) continue;
                const float next = view.inverse_depth(u + du, v + dv);
                if (std::abs(next - own) > std::abs(other - own)) other = next;
            }
            if (own <= 0 || other <= 0 || !is_edge(own, other)) continue;
            const std::uint64_t bits = bits_of(seed, u, v);
            const double fate = uniform(bits);
            if (fate < kTakenOut) {
                inverse(u, v) = 0;
            } else if (fate < kFlying) {
                const auto share = static_cast<float>(uniform(mix(bits)));
                inverse(u, v) = 1 / ((1 - share) / own + share / other);
            }
        }
    }
    return inverse;
}

/// Stereo: windows that see a nearer thing take its disparity, which makes it wider by a ragged rim; beside
/// it, on the side of the other imager, nothing is seen by both.
Image<float> with_bleeding(const View& view, double baseline_m, std::uint64_t seed) {
    const int reach = std::max(1, view.camera.width / 212);
    constexpr int kPatch = 4;
    Image<float> inverse = view.inverse_depth;
    Occlusion occlusion(view.camera, baseline_m);
    for (int v = 0; v < inverse.height; ++v) {
        occlusion.light_up(view.inverse_depth.row(v));
        for (int u = 0; u < inverse.width; ++u) {
            const float own = view.inverse_depth(u, v);
            const auto rim = static_cast<int>(bits_of(seed, u / kPatch, v / kPatch) >> 20) & 0x7fff;
            const int radius = rim % (reach + 1);
            float nearest = own;
            for (int k = -radius; k <= radius; ++k) {
                if (inverse.contains(u + k, v)) nearest = std::max(nearest, view.inverse_depth(u + k, v));
                if (inverse.contains(u, v + k)) nearest = std::max(nearest, view.inverse_depth(u, v + k));
            }
            if (own > 0 && is_edge(own, nearest)) {
                inverse(u, v) = nearest;
            } else if (own > 0 && occlusion.hides(u, own)) {
                inverse(u, v) = 0;
            }
        }
    }
    return inverse;
}

/// Lidar: few beams, spread over an image: at edges a mean of what is around.
Image<float> smeared(const View& view) {
    constexpr int kReach = 2;
    Image<float> inverse = view.inverse_depth;
    for (int v = 0; v < inverse.height; ++v) {
        for (int u = 0; u < inverse.width; ++u) {
            float low = view.inverse_depth(u, v), high = low, sum = 0;
            int count = 0;
            for (int y = std::max(0, v - kReach); y <= std::min(inverse.height - 1, v + kReach); ++y) {
                for (int x = std::max(0, u - kReach); x <= std::min(inverse.width - 1, u + kReach); ++x) {
                    const float value = view.inverse_depth(x, y);
                    if (value <= 0) continue;
                    low = std::min(low, value), high = std::max(high, value);
                    sum += 1 / value, ++count;
                }
            }
            if (low > 0 && is_edge(low, high)) inverse(u, v) = static_cast<float>(count) / sum;
        }
    }
    return inverse;
}

/// Unit noise whose neighbours are alike over `spacing` pixels: between random nodes, linear, without the
/// variance that this takes away.
Image<float> smooth_noise(int width, int height, int spacing, const GaussianTable& gaussian,
                          std::uint64_t seed) {
    const auto node = [&](int column, int row) { return gaussian[bits_of(seed, column, row) >> 24]; };
    Image<float> noise(width, height);
    for (int v = 0; v < height; ++v) {
        const float y = static_cast<float>(v % spacing) / static_cast<float>(spacing);
        for (int u = 0; u < width; ++u) {
            const float x = static_cast<float>(u % spacing) / static_cast<float>(spacing);
            const int column = u / spacing, row = v / spacing;
            const float sum = (1 - y) * ((1 - x) * node(column, row) + x * node(column + 1, row)) +
                              y * ((1 - x) * node(column, row + 1) + x * node(column + 1, row + 1));
            const float variance = ((1 - x) * (1 - x) + x * x) * ((1 - y) * (1 - y) + y * y);
            noise(u, v) = sum / std::sqrt(variance);
        }
    }
    return noise;
}

/// Stereo needs something to match: for each pixel the mean step of grey along the row, in a window of 9 x 9.
Image<float> texture_of(const World& world, const View& view) {
    constexpr int kHalf = 4;
    LaneImage lanes(view.camera.width, view.camera.height);
    shade(world, view, 1, lanes);
    Image<double> sums(lanes.width + 1, lanes.height + 1);
    const auto grey = [&](int u, int v) {
        const std::uint64_t c = lanes(u, v);
        return static_cast<double>((c & 0xffff) + (c >> 16 & 0xffff) + (c >> 32 & 0xffff)) / 3;
    };
    for (int v = 0; v < lanes.height; ++v) {
        double row = 0;
        for (int u = 0; u < lanes.width; ++u) {
            row += u > 0 ? std::abs(grey(u, v) - grey(u - 1, v)) : 0;
            sums(u + 1, v + 1) = sums(u + 1, v) + row;
        }
    }
    Image<float> texture(lanes.width, lanes.height);
    for (int v = 0; v < lanes.height; ++v) {
        const int top = std::max(0, v - kHalf), bottom = std::min(lanes.height, v + kHalf + 1);
        for (int u = 0; u < lanes.width; ++u) {
            const int left = std::max(0, u - kHalf), right = std::min(lanes.width, u + kHalf + 1);
            const double sum = sums(right, bottom) - sums(left, bottom) - sums(right, top) + sums(left, top);
            texture(u, v) = static_cast<float>(sum / ((right - left) * (bottom - top)));
        }
    }
    return texture;
}

/// On bare walls the projector's dots are all there is to match, and they grow dim with the square of the
/// range: nothing is lost to 2.3 m, a quarter at 3 m, two thirds at 4 m, in patches.
void lose_bare_walls(const World& world, const View& view, std::uint64_t seed, Image<float>& inverse) {
    constexpr float kDotsAt1m = 8;  // grey levels
    constexpr double kNeeded = 1.5;
    constexpr int kPatch = 12;
    const Image<float> texture = texture_of(world, view);
    for (int v = 0; v < inverse.height; ++v) {
        for (int u = 0; u < inverse.width; ++u) {
            const float own = inverse(u, v);
            const double there = static_cast<double>(texture(u, v) + kDotsAt1m * own * own);
            const double patch = uniform(bits_of(seed, u / kPatch, v / kPatch));
            if (kNeeded * (0.9 * patch + 0.1 * uniform(bits_of(seed + 1, u, v))) > there) inverse(u, v) = 0;
        }
    }
}

Image<float> inverse_as_seen(const View& view, const DepthSensorOptions& options, std::uint64_t seed) {
    if (!options.edges) return view.inverse_depth;
    if (options.principle == Principle::kTimeOfFlight) return with_flying_pixels(view, seed);
    if (options.principle == Principle::kStereo) return with_bleeding(view, options.baseline_m, seed);
    return smeared(view);
}

/// Pixels over which noise is alike: stereo's windows, the beams of a lidar.
int noise_spacing(Principle principle) {
    return principle == Principle::kStereo ? 3 : principle == Principle::kLidar ? 6 : 1;
}

}  // namespace

DepthImage sense_otherwise(const World& world, const View& view, const DepthSensorOptions& options,
                           const GaussianTable& gaussian, std::uint64_t seed) {
    const int width = view.camera.width, height = view.camera.height;
    Image<float> inverse = inverse_as_seen(view, options, mix(seed, 3));
    if (options.holes && options.principle == Principle::kStereo)
        lose_bare_walls(world, view, mix(seed, 5), inverse);
    const Image<float> noise =
        smooth_noise(width, height, noise_spacing(options.principle), gaussian, mix(seed, 7));
    const Grazing grazing(world, view, options, seed);
    const RawScale to_raw(options);
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            const float seen = inverse(u, v);
            if (seen <= 0 || (options.holes && grazing.loses(u, v, seen, bits_of(seed, u, v)))) continue;
            const double z = 1 / static_cast<double>(seen);
            const auto sigma = static_cast<float>(options.sigma.sigma(z));
            depth(u, v) = to_raw(static_cast<float>(z) + sigma * noise(u, v));
        }
    }
    return depth;
}

}  // namespace planemap::simulator
