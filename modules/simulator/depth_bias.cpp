// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/depth_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/random.hpp"

namespace planemap::simulator {

namespace {

constexpr double kReference_m = 4;
constexpr float kLeastInverse = 1e-4f;  // what is bent beyond all ranges stays a reading beyond all ranges

/// Smooth functions over an image, x and y from -1 to 1, that do not run away at its edges.
std::array<double, 8> basis(double x, double y) {
    constexpr double kPi = std::numbers::pi;
    const double odd_x = std::sin(kPi / 2 * x), odd_y = std::sin(kPi / 2 * y);
    const double even_x = std::cos(kPi * x), even_y = std::cos(kPi * y);
    return {1, odd_x, odd_y, even_x + even_y, even_x - even_y, odd_x * odd_y, odd_x * even_y, even_x * odd_y};
}

Image<float> random_field(const PinholeCamera& camera, std::uint64_t specimen, double rms) {
    constexpr std::array<double, 8> kSizes{1, 1, 1, 1, 0.7, 1, 0.7, 0.7};
    static const GaussianTable kGaussian;
    Image<float> field(camera.width, camera.height);
    std::array<double, 8> weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = kSizes[i] * static_cast<double>(kGaussian[mix(specimen, 83, i) >> 20]);
    double squares = 0;
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
            const auto values = basis(2.0 * u / std::max(1, camera.width - 1) - 1,
                                      2.0 * v / std::max(1, camera.height - 1) - 1);
            double sum = 0;
            for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * values[i];
            field(u, v) = static_cast<float>(sum);
            squares += sum * sum;
        }
    }
    const double scale = rms / std::sqrt(squares / static_cast<double>(field.pixels.size()));
    for (float& value : field.pixels) value = static_cast<float>(value * scale);
    return field;
}

}  // namespace

DepthBias::DepthBias(Principle principle, double relative_at_4m, const PinholeCamera& camera,
                     std::uint64_t specimen)
    : principle_(principle),
      field_(random_field(camera, specimen, relative_at_4m)),
      wave_m_(principle == Principle::kTimeOfFlight ? static_cast<float>(relative_at_4m) : 0.0f),
      phase_(static_cast<float>(uniform(mix(specimen, 89), 0, 2 * std::numbers::pi))) {}

float DepthBias::biased(float inverse, float field) const {
    if (principle_ == Principle::kStructuredLight || principle_ == Principle::kStereo) {
        // z (1 + field z / 4 m) to first order.
        return std::max(inverse - field / static_cast<float>(kReference_m), kLeastInverse);
    }
    const float z = 1 / inverse;
    const float wave =
        wave_m_ * std::sin(2 * std::numbers::pi_v<float> * z / static_cast<float>(kPhaseRange_m) + phase_);
    return 1 / std::max(z * (1 + field) + wave, 1e-3f);
}

double DepthBias::read(int u, int v, double depth_m) const {
    return 1 / static_cast<double>(biased(static_cast<float>(1 / depth_m), field_(u, v)));
}

void DepthBias::apply(View& view) const {
    for (std::size_t i = 0; i < field_.pixels.size(); ++i) {
        float& inverse = view.inverse_depth.pixels[i];
        if (inverse > 0) inverse = biased(inverse, field_.pixels[i]);
    }
}

}  // namespace planemap::simulator
