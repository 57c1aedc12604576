// SPDX-License-Identifier: BSD-3-Clause
#include "core/lens_distortion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/number_text.hpp"

namespace planemap {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Model = LensDistortion::Model;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

Vector2d brown(const std::vector<double>& given, const Vector2d& p) {
    std::array<double, 8> k{};
    std::copy(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(std::min(given.size(), k.size())),
              k.begin());
    const double r2 = p.squaredNorm(), xy = 2 * p.x() * p.y();
    const double below = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    if (!(below > 0)) return {kNowhere, kNowhere};
    const double radial = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / below;
    return {radial * p.x() + k[2] * xy + k[3] * (r2 + 2 * p.x() * p.x()),
            radial * p.y() + k[2] * (r2 + 2 * p.y() * p.y()) + k[3] * xy};
}

Vector2d fisheye(const std::vector<double>& k, const Vector2d& p) {
    const double r = p.norm();
    if (r < 1e-12) return p;
    const double angle = std::atan(r), a2 = angle * angle;
    return angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))) / r * p;
}

Matrix2d jacobian(const LensDistortion& lens, const Vector2d& p) {
    constexpr double kStep = 1e-6;
    Matrix2d derivatives;
    for (int i = 0; i < 2; ++i) {
        const Vector2d step = kStep * Vector2d::Unit(i);
        derivatives.col(i) = (distorted(lens, p + step) - distorted(lens, p - step)) / (2 * kStep);
    }
    return derivatives;
}

bool has_counted(const LensDistortion& lens) {
    const auto& counts = coefficient_counts(lens.model);
    return std::find(counts.begin(), counts.end(), lens.coefficients.size()) != counts.end();
}

std::string text_of(const LensDistortion& lens) {
    std::string text = name_of(lens.model);
    for (std::size_t i = 0; i < lens.coefficients.size() && i < 9; ++i)
        text += (i == 0 ? " [" : ", ") + short_number_text(lens.coefficients[i]);
    return text + (lens.coefficients.empty() ? " []" : lens.coefficients.size() > 9 ? ", ...]" : "]");
}

/// Whether the lens keeps the image's places in their order about `p`: what is further out stays further out,
/// and nothing is turned inside out.
bool keeps_order(const LensDistortion& lens, const Vector2d& p) {
    const Matrix2d derivatives = jacobian(lens, p);
    if (!(derivatives.determinant() > 1e-6)) return false;  // nor NaN
    return p.isZero() || p.dot(derivatives * p) > 0;
}

}  // namespace

const char* name_of(Model model) {
    return model == Model::kBrown ? "brown" : "fisheye";
}

std::optional<Model> distortion_model(const std::string& name) {
    for (const Model model : {Model::kBrown, Model::kFisheye})
        if (name == name_of(model)) return model;
    return std::nullopt;
}

const std::vector<std::size_t>& coefficient_counts(Model model) {
    static const std::vector<std::size_t> kBrown{4, 5, 8}, kFisheye{4};
    return model == Model::kBrown ? kBrown : kFisheye;
}

Vector2d distorted(const LensDistortion& lens, const Vector2d& ideal) {
    return lens.model == Model::kBrown ? brown(lens.coefficients, ideal) : fisheye(lens.coefficients, ideal);
}

std::optional<Vector2d> undistorted(const LensDistortion& lens, const Vector2d& drawn) {
    constexpr int kMostSteps = 100;
    constexpr double kNear = 1e-10, kLongest = 0.5;
    Vector2d p = drawn;
    for (int i = 0; i < kMostSteps; ++i) {
        const Vector2d off = drawn - distorted(lens, p);
        if (off.norm() < kNear) return keeps_order(lens, p) ? std::optional(p) : std::nullopt;
        Vector2d step = jacobian(lens, p).partialPivLu().solve(off);
        if (!step.allFinite()) return std::nullopt;
        if (const double length = step.norm(); length > kLongest) step *= kLongest / length;
        p += step;
    }
    return std::nullopt;
}

Vector2d sensed_pixel(const PinholeCamera& camera, const std::optional<LensDistortion>& lens,
                      const Vector2d& pixel) {
    if (!lens) return pixel;
    const Vector2d p =
        distorted(*lens, {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy});
    return {camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy};
}

void check_distortion(const LensDistortion& lens, const PinholeCamera& camera, const std::string& field,
                      FieldErrors& errors) {
    const auto refuse = [&](const std::string& allowed) {
        errors.require(false, field, text_of(lens), allowed);
    };
    if (!has_counted(lens))
        return refuse(lens.model == Model::kBrown ? "4, 5 or 8 coefficients" : "4 coefficients");
    if (!std::all_of(lens.coefficients.begin(), lens.coefficients.end(),
                     [](double c) { return std::isfinite(c); }))
        return refuse("finite");
    if (camera.width < 2 || camera.height < 2) return refuse("of an image of 2 x 2 pixels or more");
    if (!(camera.fx > 0 && camera.fy > 0)) return;  // which is said already
    constexpr int kColumns = 32, kRows = 24;
    for (int j = 0; j <= kRows; ++j) {
        for (int i = 0; i <= kColumns; ++i) {
            const double u = -0.5 + camera.width * double(i) / kColumns,
                         v = -0.5 + camera.height * double(j) / kRows;
            if (keeps_order(lens, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy})) continue;
            return refuse("monotonic over the whole image: at pixel (" + short_number_text(u) + ", " +
                          short_number_text(v) + ") what is further out is drawn further in");
        }
    }
}

}  // namespace planemap
