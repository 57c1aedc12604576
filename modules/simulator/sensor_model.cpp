// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sensor_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/validation.hpp"
#include "simulator/depth_reading.hpp"

namespace planemap::simulator {

void DepthSensorOptions::validate() const {
    FieldErrors errors("depth sensor options");
    const auto positive = [&](double value, const char* field) {
        errors.require(std::isfinite(value) && value > 0, field, value, "finite and greater than 0");
    };
    positive(units_per_metre, "units_per_metre");
    positive(disparity_steps, "disparity_steps");
    positive(baseline_m, "baseline_m");
    errors.require(min_m >= 0, "min_m", min_m, "at least 0");
    errors.require(std::isfinite(max_m) && max_m > min_m, "max_m", max_m, "finite and greater than min_m");
    errors.require(edge_jitter >= 0 && edge_jitter <= 0.5, "edge_jitter", edge_jitter, "0 to 0.5");
    errors.require(grazing_from_deg >= 0 && grazing_from_deg < grazing_to_deg, "grazing_from_deg",
                   grazing_from_deg, "at least 0 and less than grazing_to_deg");
    errors.require(grazing_to_deg <= 90, "grazing_to_deg", grazing_to_deg, "at most 90");
    errors.throw_if_any();
}

namespace {

/// Depth as a disparity with noise, in steps.
struct Measurement {
    float disparity_at_1m, steps, base, quadratic, offset;

    /// `noise` is standard normal; an inverse depth of 0 gives a depth out of any range. A loop that
    /// compilers vectorise.
    void measure(const float* inverse, const float* noise, std::size_t count, float* depth) const {
        const float step_at_1m = 0.288675f / (disparity_at_1m * steps);  // a step / sqrt(12)
        const Measurement m = *this;
        for (std::size_t i = 0; i < count; ++i) {
            const float z = 1 / std::max(inverse[i], 1e-6f), from_offset = z - m.offset;
            const float sigma = m.base + m.quadratic * from_offset * from_offset;
            const float quantisation = step_at_1m * z * z;
            const float extra = std::sqrt(std::max(0.0f, sigma * sigma - quantisation * quantisation));
            const float disparity = m.disparity_at_1m * inverse[i] * (1 + extra * inverse[i] * noise[i]);
            const float whole = static_cast<float>(nearest_whole<int>(disparity * m.steps));
            depth[i] = m.disparity_at_1m * m.steps / std::max(whole, 1e-3f);
        }
    }
};

/// Reads one view row by row.
class DepthReader {
  public:
    DepthReader(const World& world, const View& view, const DepthSensorOptions& options,
                const GaussianTable& gaussian, std::uint64_t seed)
        : view_(view),
          jitter_limit_(options.edges ? static_cast<unsigned>(256 * options.edge_jitter) : 0),
          edges_(options.edges),
          holes_(options.holes),
          gaussian_(gaussian),
          seed_(seed),
          to_raw_(options),
          measurement_{static_cast<float>(view.camera.fx * options.baseline_m),
                       static_cast<float>(options.disparity_steps), static_cast<float>(options.sigma.base_m),
                       static_cast<float>(options.sigma.quadratic_per_m),
                       static_cast<float>(options.sigma.offset_m)},
          occlusion_(view.camera, options.baseline_m),
          grazing_(world, view, options, seed) {
        for (const Rectangle& rectangle : world.rectangles) surface_of_.push_back(rectangle.surface);
        const auto width = static_cast<std::size_t>(view.camera.width);
        for (auto* row : {&inverse_, &noise_, &depth_}) row->resize(width);
        at_edge_.resize(width);
        for (auto* row : {&here_, &below_}) {
            row->bits.resize(width + 1);
            row->white.resize(width + 1);
        }
        fill_random(0, below_);
    }

    /// Rows are read in order, each once.
    void read_row(int v, std::uint16_t* out) {
        std::swap(here_, below_);
        fill_random(v + 1, below_);
        const float* inverse_depth = view_.inverse_depth.row(v);
        occlusion_.light_up(inverse_depth);
        find_edges(v);
        const auto width = static_cast<std::size_t>(view_.camera.width);
        for (std::size_t i = 0; i < width; ++i) {
            const int u = static_cast<int>(i);
            const auto [seen_u, seen_v] = at_edge_[i] != 0 ? jittered(u, v) : std::pair{u, v};
            const float inverse = at_edge_[i] != 0 ? view_.inverse_depth(seen_u, seen_v) : inverse_depth[i];
            const bool dark = inverse <= 0 || (edges_ && occlusion_.hides(seen_u, inverse)) ||
                              (holes_ && grazing_.loses(seen_u, seen_v, inverse,
                                                        here_.bits[static_cast<std::size_t>(seen_u)]));
            inverse_[i] = dark ? 0 : inverse;
        }
        for (std::size_t i = 0; i < width; ++i) {
            // Alike in neighbouring pixels, as the sensor's windows overlap; standard normal.
            noise_[i] = 0.5f * (here_.white[i] + here_.white[i + 1] + below_.white[i] + below_.white[i + 1]);
        }
        measurement_.measure(inverse_.data(), noise_.data(), width, depth_.data());
        for (std::size_t i = 0; i < width; ++i) {
            out[i] = inverse_[i] > 0 ? to_raw_(depth_[i]) : std::uint16_t{0};
        }
    }

  private:
    struct RandomRow {
        std::vector<std::uint64_t> bits;
        std::vector<float> white;  // standard normal, from the lowest 12 bits
    };

    void fill_random(int v, RandomRow& row) const {
        const std::uint64_t row_seed = mix(seed_, static_cast<std::uint64_t>(v));
        for (std::size_t u = 0; u < row.bits.size(); ++u) {
            row.bits[u] = mix(row_seed + u);
            row.white[u] = gaussian_[row.bits[u]];
        }
    }

    /// Marks the pixels that have another rectangle within one pixel.
    void find_edges(int v) {
        const int width = view_.camera.width;
        const std::int16_t *here = view_.rectangle.row(v), *above = view_.rectangle.row(std::max(v - 1, 0)),
                           *below = view_.rectangle.row(std::min(v + 1, view_.camera.height - 1));
        at_edge_.front() = at_edge_.back() = 1;
        for (int u = 1; u + 1 < width; ++u) {
            int differs = 0;
            for (const std::int16_t* row : {above, here, below}) {
                differs |= (row[u - 1] ^ here[u]) | (row[u] ^ here[u]) | (row[u + 1] ^ here[u]);
            }
            at_edge_[static_cast<std::size_t>(u)] = differs != 0;
        }
    }

    int surface(int u, int v) const {
        const std::int16_t rectangle = view_.rectangle(u, v);
        return rectangle < 0 ? -1 : surface_of_[static_cast<std::size_t>(rectangle)];
    }

    /// The pixel that the reading of (u, v) comes from: its own, or a neighbour on another surface.
    std::pair<int, int> jittered(int u, int v) const {
        const std::uint64_t bits = here_.bits[static_cast<std::size_t>(u)];
        const auto step = [limit = jitter_limit_](std::uint64_t byte) {
            return byte < limit ? -1 : byte >= 256 - limit ? 1 : 0;
        };
        const int du = step(bits >> 12 & 255), dv = step(bits >> 20 & 255);
        const bool other =
            view_.rectangle.contains(u + du, v + dv) && surface(u + du, v + dv) != surface(u, v);
        return other ? std::pair{u + du, v + dv} : std::pair{u, v};
    }

    const View& view_;
    unsigned jitter_limit_;  // of 256
    bool edges_, holes_;
    const GaussianTable& gaussian_;
    std::uint64_t seed_;
    RawScale to_raw_;
    Measurement measurement_;
    Occlusion occlusion_;
    Grazing grazing_;
    std::vector<int> surface_of_;
    std::vector<float> inverse_, noise_, depth_;
    std::vector<std::uint8_t> at_edge_;
    RandomRow here_, below_;
};

}  // namespace

namespace {

/// Exact depth within the range.
DepthImage exact_depth(const View& view, const DepthSensorOptions& options) {
    DepthImage depth(view.camera.width, view.camera.height);
    const RawScale to_raw(options);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) depth(u, v) = to_raw(view.depth(u, v));
    }
    return depth;
}

/// Share of a sensor's light that a pane throws away, there and back, by Fresnel's law for glass of index 1.5
/// (Schlick's approximation), at the cosine of its angle to the normal.
double lost_at_pane(double cosine) {
    const double once = 0.04 + 0.96 * std::pow(1 - cosine, 5);
    return 1 - std::pow(1 - once, 4);
}

/// Takes out what gives no light back: black surfaces, and in patches what is behind a pane that is looked
/// through aslant.
void take_out(const World& world, const View& view, bool with_panes, std::uint64_t seed, DepthImage& depth) {
    const auto is_black = [&](std::int16_t i) {
        return i >= 0 && world.rectangles[static_cast<std::size_t>(i)].material == Material::kBlack;
    };
    const bool any_black = std::any_of(world.rectangles.begin(), world.rectangles.end(),
                                       [](const Rectangle& r) { return r.material == Material::kBlack; });
    if (!any_black && view.mirror.empty()) return;
    const Eigen::Matrix3d camera_from_world = view.world_from_camera.linear().transpose();
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            if (is_black(view.rectangle(u, v))) depth(u, v) = 0;
            if (view.mirror.empty()) continue;
            if (is_black(view.mirrored(u, v))) depth(u, v) = 0;
            const std::int16_t pane = view.pane(u, v);
            if (pane < 0 || !with_panes) continue;
            const auto surface = world.rectangles[static_cast<std::size_t>(pane)].surface;
            const Eigen::Vector3d normal =
                camera_from_world * world.surfaces[static_cast<std::size_t>(surface)].plane.normal;
            const double cosine = std::abs(normal.dot(view.camera.unproject(u, v, 1).normalized()));
            const std::uint64_t patch =
                mix(seed + 2, static_cast<std::uint64_t>(v / 8), static_cast<std::uint64_t>(u / 8));
            if (uniform(patch) < lost_at_pane(cosine)) depth(u, v) = 0;
        }
    }
}

}  // namespace

DepthImage sense_depth(const World& world, const View& view, const DepthSensorOptions& options,
                       const GaussianTable& gaussian, std::uint64_t seed) {
    DepthImage depth;
    if (!options.noise) {
        depth = exact_depth(view, options);
    } else if (options.principle == Principle::kStructuredLight) {
        depth = DepthImage(view.camera.width, view.camera.height);
        DepthReader reader(world, view, options, gaussian, seed);
        for (int v = 0; v < depth.height; ++v) reader.read_row(v, depth.row(v));
    } else {
        depth = sense_otherwise(world, view, options, gaussian, seed);
    }
    take_out(world, view, options.noise && options.holes, seed, depth);
    return depth;
}

RgbImage sense_color(const LaneImage& sum, int exposures, double noise_levels, const GaussianTable& gaussian,
                     std::uint64_t seed) {
    std::array<int, GaussianTable::kMask + 1> noise;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = static_cast<int>(std::lround(noise_levels * gaussian[i]));
    }
    const int width = sum.width, height = sum.height;
    const auto scale = static_cast<std::uint64_t>(65536 / (16 * exposures));
    RgbImage image(width, height);
    std::vector<std::uint64_t> column(static_cast<std::size_t>(width) + 2);
    for (int v = 0; v < height; ++v) {
        const std::uint64_t *above = sum.row(std::max(v - 1, 0)), *here = sum.row(v),
                            *below = sum.row(std::min(v + 1, height - 1));
        for (int u = 0; u < width; ++u) {
            column[static_cast<std::size_t>(u) + 1] = above[u] + 2 * here[u] + below[u];
        }
        column.front() = column[1];
        column.back() = column[static_cast<std::size_t>(width)];
        const std::uint64_t row_seed = mix(seed, static_cast<std::uint64_t>(v));
        Rgb* out = image.row(v);
        for (int u = 0; u < width; ++u) {
            const std::uint64_t* c = column.data() + u;
            const std::uint64_t value = c[0] + 2 * c[1] + c[2],
                                bits = mix(row_seed + static_cast<std::uint64_t>(u));
            const auto channel = [&](int lane, int shift) {
                const auto mean = static_cast<int>(((value >> lane & 0xffff) * scale + 32768) >> 16);
                const int level = mean + noise[bits >> shift & GaussianTable::kMask];
                return static_cast<std::uint8_t>(std::clamp(level, 0, 255));
            };
            out[u] = {channel(0, 0), channel(32, 12), channel(16, 24)};
        }
    }
    return image;
}

}  // namespace planemap::simulator
