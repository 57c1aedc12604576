// SPDX-License-Identifier: BSD-3-Clause
#include "convert/lens_of.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/lens_distortion.hpp"
#include "core/text_file.hpp"

namespace planemap::convert {

namespace {

/// Small letters and digits alone: "Brown Conrady" and "distortion.brown_conrady" end alike.
std::string plain(const std::string& name) {
    std::string text;
    for (const unsigned char c : name)
        if (std::isalnum(c) != 0) text += static_cast<char>(std::tolower(c));
    return text;
}

std::optional<LensDistortion::Model> model_of(const std::string& name) {
    const std::string text = plain(name);
    const auto ends = [&](const char* end) { return text.ends_with(end); };
    // Both undo or mix what OpenCV's does: they are others, although their names end alike.
    if (ends("inversebrownconrady") || ends("modifiedbrownconrady")) return std::nullopt;
    if (text.empty() || ends("plumbbob") || ends("rationalpolynomial") || ends("brownconrady") ||
        ends("brown"))
        return LensDistortion::Model::kBrown;
    if (ends("equidistant") || ends("fisheye") || ends("kannalabrandt4") || ends("kannalabrandt"))
        return LensDistortion::Model::kFisheye;
    return std::nullopt;
}

}  // namespace

SaidLens lens_of(const std::string& model, std::vector<double> coefficients) {
    constexpr double kNone = 1e-6;
    const auto is_none = [&](double c) { return std::abs(c) <= kNone; };
    if (std::all_of(coefficients.begin(), coefficients.end(), is_none)) return {};
    const auto known = model_of(model);
    if (!known) return {std::nullopt, "known, but not used: distortion of model " + shown_text(model, 60)};
    const auto& counts = coefficient_counts(*known);
    const std::size_t most = counts.back();
    while (coefficients.size() > most && is_none(coefficients.back())) coefficients.pop_back();
    if (std::find(counts.begin(), counts.end(), coefficients.size()) == counts.end()) {
        return {std::nullopt, "known, but not used: distortion with " + std::to_string(coefficients.size()) +
                                  " coefficients, which " + name_of(*known) + " has not"};
    }
    return {LensDistortion{*known, std::move(coefficients)}, {}};
}

}  // namespace planemap::convert
