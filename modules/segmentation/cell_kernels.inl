// SPDX-License-Identifier: BSD-3-Clause
// The kernels' code; a file that includes it says which instruction set it is compiled for.
#include <cmath>

#include "segmentation/cell_kernels.hpp"
#include "segmentation/lanes.hpp"

namespace planemap::segmentation {
namespace {

/// Pixel offsets from a cell's centre: of the columns, and their squares.
const Float8 kColumn{-3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f};
const Float8 kColumnSquared{12.25f, 6.25f, 2.25f, 0.25f, 0.25f, 2.25f, 6.25f, 12.25f};

/// Sums of a value q over the pixels of a cell times 1, u, v, u^2, uv, v^2, with u and v in pixels from the
/// cell's centre. In Cells the lanes are eight cells.
struct Powers {
    Float8 one, u, v, uu, uv, vv;
};

/// Of one cell, its columns in the lanes: q summed over the rows once, twice and three times. With the row's
/// offset v from the centre and s = (8 - row) = 4.5 - v these are the sums of q, s q and s (s + 1) / 2 q.
struct ColumnSums {
    Float8 first, second, third;

    void clear() { first = second = third = splat(0.0f); }

    void add_row(const Float8& q) {
        first += q;
        second += first;
        third += second;
    }
};

/// Column sums of eight cells to powers.
Powers powers_of(const ColumnSums* cells) {
    Float8 q[8], uq[8], uuq[8], s[8], us[8], t[8];
    for (int k = 0; k < 8; ++k) {
        q[k] = cells[k].first;
        uq[k] = q[k] * kColumn;
        uuq[k] = q[k] * kColumnSquared;
        s[k] = cells[k].second;
        us[k] = s[k] * kColumn;
        t[k] = cells[k].third;
    }
    Powers p;
    p.one = lane_sums(q);
    p.u = lane_sums(uq);
    p.uu = lane_sums(uuq);
    p.v = p.one * 4.5f - lane_sums(s);
    p.uv = p.u * 4.5f - lane_sums(us);
    // s (s + 1) / 2 = (24.75 - 10 v + v^2) / 2
    p.vv = lane_sums(t) * 2.0f - p.one * 24.75f + p.v * 10.0f;
    return p;
}

/// Sums over the pixels of eight cells: of 1, of q = reading - reference, and of q^2.
struct CellSums {
    Powers n, q, qq;
    Float8 reference;
};

/// The same for a cell whose 64 pixels all count.
struct Full {
    static constexpr float kPixels = 64, kSquares = 336;  // 8 times the sum of kColumnSquared
};

struct Collector {
    ColumnSums n[8], q[8], qq[8];
    float reference[8];
    bool full = true;  // all cells so far

    template <typename MaskOf>
    void add(int k, const std::uint16_t* depth, std::ptrdiff_t stride, int reference_reading,
             MaskOf&& mask_of) {
        full = false;
        reference[k] = static_cast<float>(reference_reading);
        ColumnSums ones, values, squares;
        ones.clear(), values.clear(), squares.clear();
        const Float8 origin = splat(reference[k]), unit = splat(1.0f);
        for (int row = 0; row < kCellPx; ++row) {
            const Int8 raw = widen(load<Short8>(depth + row * stride));
            const Int8 mask = mask_of(row, raw);
            const Float8 value = masked(to_float(raw) - origin, mask);
            ones.add_row(masked(unit, mask));
            values.add_row(value);
            squares.add_row(value * value);
        }
        n[k] = ones;
        q[k] = values;
        qq[k] = squares;
    }

    void add_none(int k) {
        full = false;
        reference[k] = 1;
        for (ColumnSums* sums : {n + k, q + k, qq + k}) sums->clear();
    }

    void add_full(int k, const std::uint16_t* depth, std::ptrdiff_t stride, int reference_reading) {
        reference[k] = static_cast<float>(reference_reading);
        ColumnSums values, squares;
        values.clear(), squares.clear();
        const Float8 origin = splat(reference[k]);
        for (int row = 0; row < kCellPx; ++row) {
            const Float8 value = to_float(widen(load<Short8>(depth + row * stride))) - origin;
            values.add_row(value);
            squares.add_row(value * value);
        }
        n[k].first = splat(8.0f);
        n[k].second = splat(36.0f);
        n[k].third = splat(120.0f);
        q[k] = values;
        qq[k] = squares;
    }

    CellSums sums() const {
        CellSums s;
        if (full) {
            s.n = {splat(Full::kPixels),  splat(0.0f), splat(0.0f),
                   splat(Full::kSquares), splat(0.0f), splat(Full::kSquares)};
        } else {
            s.n = powers_of(n);
        }
        s.q = powers_of(q);
        s.qq = powers_of(qq);
        s.reference = load<Float8>(reference);
        return s;
    }
};

/// Where eight cells' centres lie, in normalised coordinates.
struct Centres {
    Double8 x, y;
};

/// From readings about a reference to sums of points in metres: the polynomials multiplied out.
void to_points(const CellSums& s, const Centres& at, const CellRules& rules, PointSums* out) {
    const Double8 z0 = to_double(s.reference);
    const double kx = 1 / rules.camera.fx, ky = 1 / rules.camera.fy, m = 1 / rules.units_per_metre;
    const auto depth = [&](Float8 n, Float8 q) { return z0 * to_double(n) + to_double(q); };
    const auto square = [&](Float8 n, Float8 q, Float8 qq) {
        return z0 * (z0 * to_double(n) + to_double(q) * 2.0) + to_double(qq);
    };
    const Double8 z = depth(s.n.one, s.q.one) * m, uz = depth(s.n.u, s.q.u) * (m * kx),
                  vz = depth(s.n.v, s.q.v) * (m * ky);
    const Double8 zz = square(s.n.one, s.q.one, s.qq.one) * (m * m),
                  uzz = square(s.n.u, s.q.u, s.qq.u) * (m * m * kx),
                  vzz = square(s.n.v, s.q.v, s.qq.v) * (m * m * ky),
                  uuzz = square(s.n.uu, s.q.uu, s.qq.uu) * (m * m * kx * kx),
                  uvzz = square(s.n.uv, s.q.uv, s.qq.uv) * (m * m * kx * ky),
                  vvzz = square(s.n.vv, s.q.vv, s.qq.vv) * (m * m * ky * ky);
    const Double8 n = to_double(s.n.one);
    const Double8 px = at.x * z + uz, py = at.y * z + vz;
    const Double8 xz = at.x * zz + uzz, yz = at.y * zz + vzz;
    const Double8 xx = at.x * (xz + uzz) + uuzz, yy = at.y * (yz + vzz) + vvzz,
                  xy = at.x * yz + at.y * uzz + uvzz;
    for (std::size_t k = 0; k < 8; ++k)
        out[k] = {n[k], px[k], py[k], z[k], xx[k], xy[k], xz[k], yy[k], yz[k], zz[k]};
}

/// The sensor's noise, with the rounding to raw units.
inline Float8 sigma_at(const Float8& z, const CellRules& rules) {
    const Float8 off = z - static_cast<float>(rules.noise.offset_m);
    const Float8 noise = splat(static_cast<float>(rules.noise.base_m)) +
                         off * off * static_cast<float>(rules.noise.quadratic_per_m);
    const auto rounding = static_cast<float>(1 / (12 * rules.units_per_metre * rules.units_per_metre));
    return square_root(noise * noise + rounding);
}

/// cos(limit + atan(error)): how far a cell's normal, known to within `error`, may lie from its region's.
inline Float8 widened_cosine(const Float8& error, const CellRules& rules) {
    const auto cosine = static_cast<float>(std::cos(rules.grow_angle_rad)),
               sine = static_cast<float>(std::sin(rules.grow_angle_rad));
    const Float8 sum = (splat(cosine) - error * sine) / square_root(splat(1.0f) + error * error);
    constexpr float kWidest = 0.17f;  // of about 80 degrees
    return select(sum > splat(kWidest), sum, splat(kWidest));
}

/// Least squares of relative depth in each cell: the a, b, c that minimise the sum of (1 - r w)^2 with
/// r = z / reference and w = 1 + c + a u + b v. All is written in differences to 1, so that nothing cancels.
void fit_cells(const CellSums& s, const Centres& at, const CellRules& rules, Cell* out) {
    const Float8 k = splat(1.0f) / s.reference, kk = k * k, one = splat(1.0f);
    const auto weight = [&](Float8 n, Float8 q, Float8 qq) { return n + k * q * 2.0f + kk * qq; };
    const Float8 n = weight(s.n.one, s.q.one, s.qq.one), nu = weight(s.n.u, s.q.u, s.qq.u),
                 nv = weight(s.n.v, s.q.v, s.qq.v), nuu = weight(s.n.uu, s.q.uu, s.qq.uu),
                 nuv = weight(s.n.uv, s.q.uv, s.qq.uv), nvv = weight(s.n.vv, s.q.vv, s.qq.vv);
    const Float8 r = k * s.q.one + kk * s.qq.one, ru = k * s.q.u + kk * s.qq.u, rv = k * s.q.v + kk * s.qq.v;
    const Int8 enough = s.n.one >= splat(static_cast<float>(rules.min_pixels));
    const Float8 per_n = one / select(enough, n, one);
    const Float8 mu = nu * per_n, mv = nv * per_n, mr = r * per_n;
    const Float8 uu = nuu * per_n - mu * mu, uv = nuv * per_n - mu * mv, vv = nvv * per_n - mv * mv;
    const Float8 ur = ru * per_n - mu * mr, vr = rv * per_n - mv * mr;
    const Float8 determinant = uu * vv - uv * uv;
    const Int8 determined = enough & (determinant > splat(1e-3f) * uu * vv) & (determinant > splat(1e-3f));
    const Float8 per_determinant = one / select(determined, determinant, one);
    const Float8 slope_u = -(vv * ur - uv * vr) * per_determinant,
                 slope_v = -(uu * vr - uv * ur) * per_determinant;
    const Float8 relative_mse = kk * s.qq.one * per_n - mr * mr + slope_u * ur + slope_v * vr;
    const Float8 mse_one = select(relative_mse > splat(0.0f), relative_mse, splat(0.0f));

    const auto fx = static_cast<float>(rules.camera.fx), fy = static_cast<float>(rules.camera.fy);
    const Float8 unit = splat(static_cast<float>(rules.units_per_metre)) * k;
    const Float8 w = (one - mr) * unit, mse = mse_one * unit * unit;
    const Float8 a_px = slope_u * unit, b_px = slope_v * unit;
    const Float8 a = a_px * fx, b = b_px * fy;
    const Float8 x = to_float(at.x) + mu * (1 / fx), y = to_float(at.y) + mv * (1 / fy);
    const Float8 c = w - a * x - b * y;
    const Float8 per_steepness = one / square_root(a * a + b * b + c * c);

    const Float8 sigma = sigma_at(one / w, rules), sigma_w = sigma * w * w;
    // At a grazing angle an error of the pixel's place becomes one of depth.
    const auto lateral = static_cast<float>(rules.lateral_px * rules.lateral_px);
    const auto planarity = static_cast<float>(rules.planarity_sigmas * rules.planarity_sigmas);
    const Int8 flat = mse <= (sigma_w * sigma_w + (a_px * a_px + b_px * b_px) * lateral) * planarity;
    const Int8 planar = determined & flat;
    const Float8 limit_sigmas = sigma * static_cast<float>(rules.grow_sigmas);
    const Float8 limit_m = splat(static_cast<float>(rules.grow_m));
    const Float8 reach = select(limit_sigmas > limit_m, limit_sigmas, limit_m) * w;
    // The normal's own error is sigma over the cell's width.
    const Float8 cos_limit = widened_cosine(sigma * w * (fx / kCellPx), rules);
    const float fxx = 1 / (fx * fx), fyy = 1 / (fy * fy);
    Float8 low[8] = {x,
                     y,
                     w,
                     select(planar, reach, splat(-1.0f)),
                     a * per_steepness,
                     b * per_steepness,
                     c * per_steepness,
                     cos_limit};
    Float8 high[8] = {a, b, mse, uu * fxx, vv * fyy, s.n.one, sigma, per_steepness};
    transpose(low);
    transpose(high);
    for (int i = 0; i < 8; ++i) {
        std::memcpy(static_cast<void*>(out + i), &low[i], sizeof(low[i]));
        std::memcpy(reinterpret_cast<char*>(out + i) + sizeof(low[i]), &high[i], sizeof(high[i]));
    }
}

bool any(const Short8& mask) {
    std::uint64_t parts[2];
    std::memcpy(parts, &mask, sizeof(parts));
    return (parts[0] | parts[1]) != 0;
}

/// Valid readings.
struct Range {
    Int8 low, high;

    explicit Range(const CellRules& rules)
        : low(splat(std::int32_t{rules.low})), high(splat(std::int32_t{rules.high})) {}
    Int8 holds(const Int8& raw) const { return (raw >= low) & (raw <= high); }
};

/// A valid reading of a cell, from its middle if possible; 0 if there is none.
int reference_reading(const CellRules& rules, const std::uint16_t* depth, std::ptrdiff_t stride) {
    constexpr int kPixels = kCellPx * kCellPx, kMiddle = kPixels / 2 + kCellPx / 2;
    for (int k = 0; k < kPixels; ++k) {
        const int i = (kMiddle + k) % kPixels;
        const std::uint16_t raw = depth[i / kCellPx * stride + i % kCellPx];
        if (raw >= rules.low && raw <= rules.high) return raw;
    }
    return 0;
}

void fit(const CellRules& rules, const CellGroup& group, Cell* cells, PointSums* sums) {
    const Range range(rules);
    Collector collector;
    bool empty = true;
    for (int k = 0; k < 8; ++k) {
        const std::uint16_t* depth = group.depth + std::ptrdiff_t{k} * kCellPx;
        Short8 least = load<Short8>(depth), most = least;
        for (int row = 1; row < kCellPx; ++row) {
            const Short8 raw = load<Short8>(depth + row * group.stride);
            least = smaller(least, raw);
            most = larger(most, raw);
        }
        if (!any(smaller(least, splat(rules.low)) - splat(rules.low)) &&
            !any(larger(most, splat(rules.high)) - splat(rules.high))) {
            collector.add_full(k, depth, group.stride, depth[4 * group.stride + 4]);
            empty = false;
            continue;
        }
        const bool none = !any(within(most, splat(rules.low), splat(std::uint16_t{65535}))) ||
                          !any(within(least, splat(std::uint16_t{0}), splat(rules.high)));
        const int reference = none ? 0 : reference_reading(rules, depth, group.stride);
        if (reference == 0) {
            collector.add_none(k);
            continue;
        }
        empty = false;
        collector.add(k, depth, group.stride, reference,
                      [&](int, const Int8& raw) { return range.holds(raw); });
    }
    if (empty) {
        for (int k = 0; k < 8; ++k) cells[k] = Cell{}, sums[k] = PointSums{};
        return;
    }
    const double x = (group.u + 3.5 - rules.camera.cx) / rules.camera.fx, step = kCellPx / rules.camera.fx;
    const Centres at{splat(x) + Double8{0, 1, 2, 3, 4, 5, 6, 7} * step,
                     splat((group.v + 3.5 - rules.camera.cy) / rules.camera.fy)};
    const CellSums s = collector.sums();
    fit_cells(s, at, rules, cells);
    to_points(s, at, rules, sums);
}

void sum(const CellRules& rules, const LabelledPixels* sets, PointSums* sums) {
    Collector collector;
    Centres at;
    for (std::size_t k = 0; k < 8; ++k) {
        const LabelledPixels& set = sets[k];
        const Int8 label = splat(std::int32_t{set.label});
        collector.add(static_cast<int>(k), set.depth, set.stride, set.reference, [&](int row, const Int8&) {
            return widen(load<Short8>(set.labels + row * set.stride)) == label;
        });
        at.x[k] = (set.u + 3.5 - rules.camera.cx) / rules.camera.fx;
        at.y[k] = (set.v + 3.5 - rules.camera.cy) / rules.camera.fy;
    }
    to_points(collector.sums(), at, rules, sums);
}

/// A candidate as it runs over the rows of a cell, the columns in the lanes.
struct Line {
    Float8 line, d, limit;
    float down;
    Short8 label;

    Line() = default;
    Line(const CellRules& rules, const BorderBand& band, const CellPixels& cell, const Candidate& candidate) {
        const double middle = candidate.start + candidate.right * (cell.u + 3.5) + candidate.down * cell.v;
        const auto distance = static_cast<float>(candidate.d);
        down = static_cast<float>(candidate.down);
        line = splat(static_cast<float>(middle)) + kColumn * static_cast<float>(candidate.right);
        d = splat(distance);
        const float centre = static_cast<float>(middle) + 3.5f * down;
        const float z = distance / (centre * static_cast<float>(rules.units_per_metre));
        const float off = z - static_cast<float>(band.noise.offset_m);
        const float sigmas =
            static_cast<float>(band.thickness_sigmas * band.noise.base_m) +
            static_cast<float>(band.thickness_sigmas * band.noise.quadratic_per_m) * off * off;
        const auto thickness = static_cast<float>(band.thickness_m);
        // A plane that is not in front of the camera here takes no pixel; nor is there one to take if no
        // reading is valid, which within() cannot tell.
        const bool none = !(centre > 0) || rules.high < rules.low;
        limit = splat(none ? 0.0f : sigmas > thickness ? sigmas : thickness);
        label = splat(candidate.label);
    }

    Float8 gap(const Float8& raw) const { return absolute(d - line * raw); }
    void next_row() { line += splat(down); }
};

void label_one(const CellRules& rules, const CellPixels& cell, Line line, std::uint8_t* pixels) {
    const Short8 low = splat(rules.low), high = splat(rules.high);
    Short8 count = splat(std::uint16_t{0});
    for (int row = 0; row < kCellPx; ++row) {
        const Short8 raw = load<Short8>(cell.depth + row * cell.stride);
        const Short8 near = narrow_mask(line.gap(to_float(widen(raw))) < line.limit);
        const Short8 mask = near & within(raw, low, high);
        store(mask & line.label, cell.labels + row * cell.stride);
        count -= mask;
        line.next_row();
    }
    *pixels = static_cast<std::uint8_t>(sum_of(count));
}

void label(const CellRules& rules, const BorderBand& band, const CellPixels& cell,
           const Candidate* candidates, std::size_t count, std::uint8_t* pixels) {
    if (count == 1) return label_one(rules, cell, Line(rules, band, cell, candidates[0]), pixels);
    Line lines[kMaxCandidates];
    for (std::size_t k = 0; k < count; ++k) lines[k] = Line(rules, band, cell, candidates[k]);
    Short8 counts[kMaxCandidates] = {};
    const Short8 low = splat(rules.low), high = splat(rules.high);
    for (int row = 0; row < kCellPx; ++row) {
        const Short8 raw = load<Short8>(cell.depth + row * cell.stride);
        const Float8 z = to_float(widen(raw));
        Float8 best = splat(1e9f);
        Int8 winner = splat(0);
        for (std::size_t k = 0; k < count; ++k) {
            const Float8 gap = lines[k].gap(z);
            const Int8 nearer = (gap < lines[k].limit) & (gap < best);
            best = select(nearer, gap, best);
            winner = select(nearer, splat(std::int32_t{candidates[k].label}), winner);
            lines[k].next_row();
        }
        const Short8 given = narrow(winner) & within(raw, low, high);
        store(given, cell.labels + row * cell.stride);
        for (std::size_t k = 0; k < count; ++k) counts[k] -= equal(given, lines[k].label);
    }
    for (std::size_t k = 0; k < count; ++k) pixels[k] = static_cast<std::uint8_t>(sum_of(counts[k]));
}

}  // namespace
}  // namespace planemap::segmentation
