// SPDX-License-Identifier: BSD-3-Clause
#include "exports/svg.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace planemap::exports {

std::string pixels(double value) {
    return fixed(value, 1);
}

std::string move_to(const Eigen::Vector2d& p) {
    return std::string("M") + pixels(p.x()) + "," + pixels(p.y());
}

std::string line_to(const Eigen::Vector2d& p) {
    return std::string("L") + pixels(p.x()) + "," + pixels(p.y());
}

std::string css(const Rgb& color, double shade) {
    const auto channel = [&](std::uint8_t c) {
        return std::to_string(std::clamp(std::lround(shade * c), 0l, 255l));
    };
    return std::string("rgb(") + channel(color.r) + "," + channel(color.g) + "," + channel(color.b) + ")";
}

std::string tooltip(const MapPlane& plane) {
    return "<title>plane " + std::to_string(plane.id) + ", " + label_name(plane.label) + ", " +
           fixed(static_cast<double>(plane.area), 2) + " m²</title>";
}

std::string words(const Eigen::Vector2d& at, const std::string& what, const char* attributes) {
    return "<text x=\"" + pixels(at.x()) + "\" y=\"" + pixels(at.y()) + "\" " + attributes + ">" + what +
           "</text>\n";
}

std::string page(const std::string& title, const std::string& subtitle, const std::string& body) {
    const std::string size = pixels(kPageWidth_px) + "\" height=\"" + pixels(kPageHeight_px);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
           pixels(kPageWidth_px) + " " + pixels(kPageHeight_px) +
           "\" font-family=\"sans-serif\" font-size=\"13\">\n<title>" + title + "</title>\n<rect width=\"" +
           size + "\" fill=\"white\"/>\n" + body + words({16, 24}, title, "font-size=\"17\"") +
           words({16, 41}, subtitle, "fill=\"#555\"") + "</svg>\n";
}

std::string count_of(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string up_text(const PlaneMap& map) {
    return map.up.isZero() ? "up: as the camera was held, the planes do not tell it"
                           : "up: as the planes tell it";
}

Area drawing_area(bool beside_legend) {
    return {
        {kMargin_px, kTitleHeight_px + 14},
        {kPageWidth_px - (beside_legend ? kLegendWidth_px : kMargin_px), kPageHeight_px - kFootHeight_px}};
}

Fit::Fit(const std::vector<Eigen::Vector2d>& points, const Area& area)
    : centre_(0.5 * (area.low + area.high)) {
    Eigen::Vector2d low(-1, -1), high(1, 1);
    if (!points.empty()) low = high = points[0];
    for (const Eigen::Vector2d& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Eigen::Vector2d size = (high - low).cwiseMax(1e-3);
    scale_ = (area.high - area.low).cwiseQuotient(size).minCoeff();
    middle_ = 0.5 * (low + high);
}
double round_length(double most) {
    const double power = std::pow(10, std::floor(std::log10(most)));
    return power * (5 * power <= most ? 5 : 2 * power <= most ? 2 : 1);
}

std::string metres(double length) {
    std::array<char, 32> buffer;
    return std::string(buffer.data(),
                       std::to_chars(buffer.data(), buffer.data() + buffer.size(), length).ptr) +
           " m";
}

std::string scale_bar(double pixels_per_metre) {
    const double length = round_length(kPageWidth_px / 6 / pixels_per_metre);
    const double x = kMargin_px, y = kPageHeight_px - 16, end = x + length * pixels_per_metre;
    return "<path d=\"" + move_to({x, y - 5}) + "v5H" + pixels(end) +
           "v-5\" fill=\"none\" stroke=\"black\"/>\n" +
           words({0.5 * (x + end), y - 6}, metres(length), "text-anchor=\"middle\"");
}

}  // namespace planemap::exports
