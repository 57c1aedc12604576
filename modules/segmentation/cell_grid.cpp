// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "segmentation/lanes.hpp"
#include "segmentation/shape.hpp"

namespace planemap {

namespace {

/// Calls f with the cell's side as a compile-time constant, so that the loops over a cell have a fixed
/// length.
template <typename F>
auto with_side(int cell_px, F&& f) {
    switch (cell_px) {
        case 4:
            return f(std::integral_constant<int, 4>());
        case 8:
            return f(std::integral_constant<int, 8>());
        case 12:
            return f(std::integral_constant<int, 12>());
        case 16:
            return f(std::integral_constant<int, 16>());
        case 20:
            return f(std::integral_constant<int, 20>());
        case 24:
            return f(std::integral_constant<int, 24>());
        case 28:
            return f(std::integral_constant<int, 28>());
        default:
            return f(std::integral_constant<int, 32>());
    }
}

/// Offsets from a cell's centre, in pixels, of the four columns from `column` on.
template <int N>
Float4 offsets(int column) {
    const float first = static_cast<float>(column) - 0.5f * (N - 1);
    return Float4{first, first + 1, first + 2, first + 3};
}

/// Sums over pixels of a cell of the powers of u and v (pixels from the cell's centre), of those times q, and
/// of q squared. q is a difference to a reference, so that float is exact enough.
struct ValueSums {
    double n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    double q = 0, uq = 0, vq = 0, qq = 0;
};

/// `pixel(row, column, mask)` gives q of four pixels and sets where they count.
template <int N, typename F>
ValueSums sum_values(F&& pixel) {
    Float4 n{}, un{}, uun{}, vn{}, uvn{}, vvn{}, q{}, uq{}, vq{}, qq{};
    for (int column = 0; column < N; column += 4) {
        Float4 cn{}, cv{}, cvv{}, cq{}, cvq{}, cqq{};
        float v = -0.5f * (N - 1);
        for (int row = 0; row < N; ++row, v += 1) {
            Int4 mask;
            const Float4 value = pixel(row, column, mask);
            const Float4 one = one_where(mask), masked = mask ? value : splat(0.0f);
            cn += one;
            cv += one * v;
            cvv += one * (v * v);
            cq += masked;
            cvq += masked * v;
            cqq += masked * masked;
        }
        const Float4 u = offsets<N>(column);
        n += cn, un += u * cn, uun += u * u * cn, vn += cv, uvn += u * cv, vvn += cvv;
        q += cq, uq += u * cq, vq += cvq, qq += cqq;
    }
    return {sum_of(n),   sum_of(un), sum_of(vn), sum_of(uun), sum_of(uvn),
            sum_of(vvn), sum_of(q),  sum_of(uq), sum_of(vq),  sum_of(qq)};
}

/// From sums about the cell's centre in pixels and about a reference to sums in normalised coordinates.
InverseDepthSums normalised(const ValueSums& s, double u0, double v0, double w0,
                            const PinholeCamera& camera) {
    const double kx = 1 / camera.fx, ky = 1 / camera.fy;
    const double x0 = (u0 - camera.cx) * kx, y0 = (v0 - camera.cy) * ky;
    const double x = kx * s.u, y = ky * s.v;
    InverseDepthSums out;
    out.n = s.n;
    out.x = s.n * x0 + x;
    out.y = s.n * y0 + y;
    out.w = s.n * w0 + s.q;
    out.xx = kx * kx * s.uu + 2 * x0 * x + s.n * x0 * x0;
    out.xy = kx * ky * s.uv + x0 * y + y0 * x + s.n * x0 * y0;
    out.yy = ky * ky * s.vv + 2 * y0 * y + s.n * y0 * y0;
    out.xw = kx * s.uq + x0 * s.q + w0 * x + s.n * x0 * w0;
    out.yw = ky * s.vq + y0 * s.q + w0 * y + s.n * y0 * w0;
    out.ww = s.qq + 2 * w0 * s.q + s.n * w0 * w0;
    return out;
}

/// Sums of z and z squared (raw units), times powers of u and v, over the pixels of a cell.
struct DepthSums {
    double n = 0, z = 0, uz = 0, vz = 0, zz = 0, uzz = 0, vzz = 0, uuzz = 0, uvzz = 0, vvzz = 0;
};

template <int N>
DepthSums sum_depth(const std::uint16_t* depth, std::ptrdiff_t depth_stride, const std::uint16_t* labels,
                    std::ptrdiff_t label_stride, int label, int reference) {
    // Sums over the differences q = z - reference first, which float holds exactly enough.
    Float4 n{}, un{}, uun{}, vn{}, uvn{}, vvn{};
    Float4 q{}, uq{}, uuq{}, vq{}, uvq{}, vvq{}, qq{}, uqq{}, uuqq{}, vqq{}, uvqq{}, vvqq{};
    for (int column = 0; column < N; column += 4) {
        Float4 cn{}, cv{}, cvv{}, cq{}, cvq{}, cvvq{}, cqq{}, cvqq{}, cvvqq{};
        float v = -0.5f * (N - 1);
        for (int row = 0; row < N; ++row, v += 1) {
            const Int4 mask = load4(labels + row * label_stride + column) == splat(label);
            const Int4 raw = load4(depth + row * depth_stride + column);
            const Float4 one = one_where(mask), value = to_float((raw - reference) & mask);
            const Float4 square = value * value;
            cn += one, cv += one * v, cvv += one * (v * v);
            cq += value, cvq += value * v, cvvq += value * (v * v);
            cqq += square, cvqq += square * v, cvvqq += square * (v * v);
        }
        const Float4 u = offsets<N>(column);
        n += cn, un += u * cn, uun += u * u * cn, vn += cv, uvn += u * cv, vvn += cvv;
        q += cq, uq += u * cq, uuq += u * u * cq, vq += cvq, uvq += u * cvq, vvq += cvvq;
        qq += cqq, uqq += u * cqq, uuqq += u * u * cqq, vqq += cvqq, uvqq += u * cvqq, vvqq += cvvqq;
    }
    const double z0 = reference;
    const auto first = [&](Float4 ones, Float4 values) { return z0 * sum_of(ones) + sum_of(values); };
    const auto second = [&](Float4 ones, Float4 values, Float4 squares) {
        return z0 * z0 * sum_of(ones) + 2 * z0 * sum_of(values) + sum_of(squares);
    };
    return {sum_of(n),
            first(n, q),
            first(un, uq),
            first(vn, vq),
            second(n, q, qq),
            second(un, uq, uqq),
            second(vn, vq, vqq),
            second(uun, uuq, uuqq),
            second(uvn, uvq, uvqq),
            second(vvn, vvq, vvqq)};
}

/// Moments of the points (x z, y z, z) with x = x0 + kx u, y = y0 + ky v: the polynomials multiplied out.
Moments point_moments(const DepthSums& s, double u0, double v0, double metres_per_unit,
                      const PinholeCamera& camera) {
    const double kx = 1 / camera.fx, ky = 1 / camera.fy;
    const double x0 = (u0 - camera.cx) * kx, y0 = (v0 - camera.cy) * ky;
    Moments m;
    m.count = s.n;
    m.sum = metres_per_unit * Eigen::Vector3d(x0 * s.z + kx * s.uz, y0 * s.z + ky * s.vz, s.z);
    const double xx = x0 * x0 * s.zz + 2 * x0 * kx * s.uzz + kx * kx * s.uuzz;
    const double yy = y0 * y0 * s.zz + 2 * y0 * ky * s.vzz + ky * ky * s.vvzz;
    const double xy = x0 * y0 * s.zz + x0 * ky * s.vzz + y0 * kx * s.uzz + kx * ky * s.uvzz;
    const double xz = x0 * s.zz + kx * s.uzz, yz = y0 * s.zz + ky * s.vzz;
    m.scatter << xx, xy, xz, xy, yy, yz, xz, yz, s.zz;
    m.scatter *= metres_per_unit * metres_per_unit;
    return m;
}

/// The reading of a pixel that `counts` (a row's and column's offset in the cell), from near the centre if
/// possible; 0 if there is none.
template <typename F>
int reference_reading(const std::uint16_t* rows, std::ptrdiff_t stride, int side, F&& counts) {
    const int pixels = side * side, middle = side / 2 * side + side / 2;
    for (int k = 0; k < pixels; ++k) {
        const int i = (middle + k) % pixels;
        if (counts(i / side, i % side)) return rows[i / side * stride + i % side];
    }
    return 0;
}

/// A candidate as label_rows() needs it: the distance of a pixel's point to the plane is |d - line z|, where
/// line = start + down * row + right * column.
struct LabelLine {
    float d, start, right, down;
    std::int32_t label;
};

/// max(thickness, base + quadratic (z - offset)^2), metres.
struct LabelLimit {
    float thickness, base, quadratic, offset;
};

/// Depth of a cell, its limits and the range of valid readings.
struct LabelInput {
    const std::uint16_t* depth;
    std::ptrdiff_t stride;
    std::int32_t low, high;
    float metres_per_unit;
    LabelLimit limit;
};

template <int N>
void label_rows(const LabelInput& in, std::span<const LabelLine> lines, std::uint16_t* labels,
                std::ptrdiff_t label_stride) {
    constexpr int kGroups = N / 4;
    std::array<Float4, kGroups> z, best;
    std::array<Int4, kGroups> label;
    for (int row = 0; row < N; ++row) {
        for (std::size_t g = 0; g < kGroups; ++g) {
            const Int4 raw = load4(in.depth + row * in.stride + 4 * g);
            const Int4 valid = (raw >= splat(in.low)) & (raw <= splat(in.high));
            z[g] = to_float(raw) * in.metres_per_unit;
            const Float4 off = z[g] - in.limit.offset;
            const Float4 sigmas = in.limit.base + in.limit.quadratic * off * off;
            const Float4 larger = sigmas > in.limit.thickness ? sigmas : splat(in.limit.thickness);
            best[g] = valid ? larger : splat(-1.0f);
            label[g] = splat(0);
        }
        for (const LabelLine& line : lines) {
            const Float4 step{0, line.right, 2 * line.right, 3 * line.right};
            const Float4 start = line.start + line.down * static_cast<float>(row) + step;
            for (std::size_t g = 0; g < kGroups; ++g) {
                const Float4 gap = absolute(line.d - (start + line.right * static_cast<float>(4 * g)) * z[g]);
                const Int4 nearer = gap < best[g];
                best[g] = nearer ? gap : best[g];
                label[g] = nearer ? splat(line.label) : label[g];
            }
        }
        for (std::size_t g = 0; g < kGroups; ++g) store4(label[g], labels + row * label_stride + 4 * g);
    }
}

/// As label_rows() for a single candidate, which most cells have.
template <int N>
void label_rows(const LabelInput& in, const LabelLine& line, std::uint16_t* labels,
                std::ptrdiff_t label_stride) {
    const Float4 step{0, line.right, 2 * line.right, 3 * line.right};
    for (int row = 0; row < N; ++row) {
        const Float4 start = line.start + line.down * static_cast<float>(row) + step;
        for (int column = 0; column < N; column += 4) {
            const Int4 raw = load4(in.depth + row * in.stride + column);
            const Float4 z = to_float(raw) * in.metres_per_unit, off = z - in.limit.offset;
            const Float4 sigmas = in.limit.base + in.limit.quadratic * off * off;
            const Float4 gap = absolute(line.d - (start + line.right * static_cast<float>(column)) * z);
            const Int4 near = (gap < in.limit.thickness) | (gap < sigmas);
            const Int4 valid = (raw >= splat(in.low)) & (raw <= splat(in.high));
            store4(near & valid & line.label, labels + row * label_stride + column);
        }
    }
}

template <int N>
int count_label(const std::uint16_t* labels, std::ptrdiff_t stride, int label) {
    Int4 total{};
    for (int row = 0; row < N; ++row) {
        for (int column = 0; column < N; column += 4)
            total -= load4(labels + row * stride + column) == splat(label);
    }
    return sum_of(total);
}

}  // namespace

void CellGrid::reset(const DepthImage& depth, const CameraInfo& camera, double cell_px) {
    depth_ = &depth;
    camera_ = camera.depth;
    units_per_metre_ = camera.depth_units_per_metre;
    const DepthRange range(camera);
    low_ = range.low;
    high_ = range.high;
    cell_px_ = 4 * static_cast<int>(std::lround(std::clamp(cell_px / 4, 1.0, 8.0)));
    columns_ = (depth.width + cell_px_ - 1) / cell_px_;
    rows_ = (depth.height + cell_px_ - 1) / cell_px_;
}

CellGrid::Place CellGrid::place(int cell) const {
    const int u = cell % columns_ * cell_px_, v = cell / columns_ * cell_px_;
    return {u, v, std::min(cell_px_, depth_->width - u), std::min(cell_px_, depth_->height - v)};
}

CellGrid::Rows CellGrid::rows_of(const Image<std::uint16_t>& image, int cell, Patch& patch) const {
    const Place at = place(cell);
    if (at.width == cell_px_ && at.height == cell_px_) return {image.row(at.v) + at.u, image.width};
    patch.pixels.fill(0);
    for (int r = 0; r < at.height; ++r)
        std::copy_n(image.row(at.v + r) + at.u, at.width, patch.pixels.begin() + r * cell_px_);
    return {patch.pixels.data(), cell_px_};
}

InverseDepthSums CellGrid::inverse_depth_sums(int cell) const {
    Patch patch;
    const Rows rows = rows_of(*depth_, cell, patch);
    const int reference = reference_reading(rows.first, rows.stride, cell_px_, [&](int row, int column) {
        const std::uint16_t raw = rows.first[row * rows.stride + column];
        return raw >= low_ && raw <= high_;
    });
    if (reference == 0) return {};
    return with_side(cell_px_, [&](auto side) {
        constexpr int kSide = decltype(side)::value;
        const auto units = static_cast<float>(units_per_metre_);
        const float w0 = units / static_cast<float>(reference);
        const ValueSums s = sum_values<kSide>([&](int row, int column, Int4& mask) {
            const Int4 raw = load4(rows.first + row * rows.stride + column);
            mask = (raw >= splat(low_)) & (raw <= splat(high_));
            return units / to_float(mask ? raw : splat(1)) - w0;
        });
        const Place at = place(cell);
        return normalised(s, at.u + 0.5 * (kSide - 1), at.v + 0.5 * (kSide - 1), static_cast<double>(w0),
                          camera_);
    });
}

double CellGrid::inverse_depth_at(int cell, const InverseDepthPlane& plane) const {
    const Place at = place(cell);
    const double x = (at.u + 0.5 * (cell_px_ - 1) - camera_.cx) / camera_.fx;
    const double y = (at.v + 0.5 * (cell_px_ - 1) - camera_.cy) / camera_.fy;
    return std::clamp(plane.at(x, y), units_per_metre_ / high_, units_per_metre_ / low_);
}

InverseDepthSums CellGrid::inverse_depth_sums(int cell, const Image<std::uint16_t>& labels,
                                              const Candidate& candidate) const {
    Patch patch, label_patch;
    const Rows rows = rows_of(*depth_, cell, patch), marks = rows_of(labels, cell, label_patch);
    const auto w0 = static_cast<float>(inverse_depth_at(cell, candidate.plane));
    return with_side(cell_px_, [&](auto side) {
        constexpr int kSide = decltype(side)::value;
        const auto units = static_cast<float>(units_per_metre_);
        const ValueSums s = sum_values<kSide>([&](int row, int column, Int4& mask) {
            mask = load4(marks.first + row * marks.stride + column) == splat(candidate.label);
            const Int4 raw = load4(rows.first + row * rows.stride + column);
            return units / to_float(mask ? raw : splat(1)) - w0;
        });
        const Place at = place(cell);
        return normalised(s, at.u + 0.5 * (kSide - 1), at.v + 0.5 * (kSide - 1), static_cast<double>(w0),
                          camera_);
    });
}

Moments CellGrid::moments(int cell, const Image<std::uint16_t>& labels, const Candidate& candidate) const {
    Patch patch, label_patch;
    const Rows rows = rows_of(*depth_, cell, patch), marks = rows_of(labels, cell, label_patch);
    const auto reference = static_cast<int>(units_per_metre_ / inverse_depth_at(cell, candidate.plane));
    return with_side(cell_px_, [&](auto side) {
        constexpr int kSide = decltype(side)::value;
        const DepthSums s =
            sum_depth<kSide>(rows.first, rows.stride, marks.first, marks.stride, candidate.label, reference);
        const Place at = place(cell);
        return point_moments(s, at.u + 0.5 * (kSide - 1), at.v + 0.5 * (kSide - 1), 1 / units_per_metre_,
                             camera_);
    });
}

std::array<int, CellGrid::kMaxCandidates> CellGrid::label(int cell, std::span<const Candidate> candidates,
                                                          const BorderBand& band,
                                                          Image<std::uint16_t>& labels) const {
    const Place at = place(cell);
    const std::size_t count = std::min(candidates.size(), kMaxCandidates);
    std::array<LabelLine, kMaxCandidates> lines;
    for (std::size_t k = 0; k < count; ++k) {
        const InverseDepthPlane& plane = candidates[k].plane;
        const double d = 1 / plane.steepness();
        const double x = (at.u - camera_.cx) / camera_.fx, y = (at.v - camera_.cy) / camera_.fy;
        lines[k] = {static_cast<float>(d), static_cast<float>(d * plane.at(x, y)),
                    static_cast<float>(d * plane.a / camera_.fx),
                    static_cast<float>(d * plane.b / camera_.fy), candidates[k].label};
    }
    Patch patch, result;
    const Rows rows = rows_of(*depth_, cell, patch);
    const LabelInput input{
        rows.first,
        rows.stride,
        low_,
        high_,
        static_cast<float>(1 / units_per_metre_),
        {static_cast<float>(band.thickness_m), static_cast<float>(band.thickness_sigmas * band.noise.base_m),
         static_cast<float>(band.thickness_sigmas * band.noise.quadratic_per_m),
         static_cast<float>(band.noise.offset_m)}};
    const bool whole = rows.first != patch.pixels.data();
    std::uint16_t* out = whole ? labels.row(at.v) + at.u : result.pixels.data();
    const std::ptrdiff_t stride = whole ? labels.width : cell_px_;
    std::array<int, kMaxCandidates> counts{};
    with_side(cell_px_, [&](auto side) {
        constexpr int kSide = decltype(side)::value;
        if (count == 1) {
            label_rows<kSide>(input, lines[0], out, stride);
        } else {
            label_rows<kSide>(input, std::span<const LabelLine>(lines).first(count), out, stride);
        }
        for (std::size_t k = 0; k < count; ++k) counts[k] = count_label<kSide>(out, stride, lines[k].label);
    });
    if (!whole) {
        for (int r = 0; r < at.height; ++r)
            std::copy_n(result.pixels.begin() + r * cell_px_, at.width, labels.row(at.v + r) + at.u);
    }
    return counts;
}

}  // namespace planemap
