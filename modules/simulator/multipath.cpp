// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/depth_bias.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr int kNodes = 40;  // across an image

/// A piece of what is lit, at every so many pixels.
struct Node {
    int surface = -1;        ///< -1: nothing that scatters
    Vector3d point, normal;  ///< camera frame
    double range = 0;        ///< from the camera
    double light = 0;        ///< solid angle of the piece: the share of the sensor's light that it gets
    double area = 0;
    double excess = 0;  ///< by which its range is read too long, metres
};

/// Nodes in rows over a view; pixels between them are interpolated on their own surface.
class NodeGrid {
  public:
    NodeGrid(const World& world, const View& view)
        : world_(world),
          step_(std::max(2, view.camera.width / kNodes)),
          columns_((view.camera.width + step_ - 1) / step_ + 1),
          rows_((view.camera.height + step_ - 1) / step_ + 1) {
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) nodes_.push_back(look(view, column, row));
        }
    }

    /// Fills in the excess of every node from the light of all others.
    void bounce(double strength) {
        for (Node& to : nodes_) {
            if (to.surface >= 0) to.excess = excess_at(to, strength);
        }
    }

    double excess(int u, int v, int surface) const {
        const int column = u / step_, row = v / step_;
        const double x = static_cast<double>(u) / step_ - column, y = static_cast<double>(v) / step_ - row;
        double sum = 0, weights = 0;
        for (int k = 0; k < 4; ++k) {
            const int right = k & 1, down = k >> 1, at = (row + down) * columns_ + column + right;
            const Node& node = nodes_[static_cast<std::size_t>(at)];
            const double weight = (right != 0 ? x : 1 - x) * (down != 0 ? y : 1 - y);
            if (node.surface != surface) continue;
            sum += weight * node.excess;
            weights += weight;
        }
        return weights > 0 ? sum / weights : 0;
    }

  private:
    Node look(const View& view, int column, int row) const {
        const int u = std::min(column * step_, view.camera.width - 1);
        const int v = std::min(row * step_, view.camera.height - 1);
        Node node;
        const int index = view.rectangle(u, v);
        if (index < 0) return node;
        const Rectangle& rectangle = world_.rectangles[static_cast<std::size_t>(index)];
        if (rectangle.material != Material::kMatt) return node;
        const Plane& plane = world_.surfaces[static_cast<std::size_t>(rectangle.surface)].plane;
        node.surface = rectangle.surface;
        node.point = view.camera.unproject(u, v, view.depth(u, v));
        node.normal = view.world_from_camera.linear().transpose() * plane.normal;
        node.range = node.point.norm();
        const double ahead = node.point.z() / node.range;
        node.light = step_ * step_ / (view.camera.fx * view.camera.fy) * ahead * ahead * ahead;
        const double towards = std::max(0.05, -node.normal.dot(node.point) / node.range);
        node.area = node.light * node.range * node.range / towards;
        return node;
    }

    double excess_at(const Node& to, double strength) const {
        constexpr double kScattered = 0.6;
        const double direct = std::max(0.05, -to.normal.dot(to.point) / to.range) / (to.range * to.range);
        double in_phase = 1, behind = 0;  // the sum of all light as a phasor, against the direct way's
        for (const Node& from : nodes_) {
            if (from.surface < 0 || from.surface == to.surface) continue;
            const Vector3d way = to.point - from.point;
            const double leaves = from.normal.dot(way), arrives = -to.normal.dot(way);
            if (leaves <= 0 || arrives <= 0) continue;
            const double squared = way.squaredNorm();
            // Two pieces that touch: as if a radius of the piece apart.
            const double apart = std::max(squared, from.area / std::numbers::pi);
            const double indirect = strength * kScattered * from.light * leaves * arrives /
                                    (std::numbers::pi * apart * apart * direct);
            const double excess = 0.5 * (from.range + std::sqrt(squared) - to.range);
            in_phase += indirect * std::cos(2 * std::numbers::pi * excess / kPhaseRange_m);
            behind += indirect * std::sin(2 * std::numbers::pi * excess / kPhaseRange_m);
        }
        return std::atan2(behind, in_phase) * kPhaseRange_m / (2 * std::numbers::pi);
    }

    const World& world_;
    int step_, columns_, rows_;
    std::vector<Node> nodes_;
};

}  // namespace

void add_multipath(const World& world, View& view, double strength) {
    NodeGrid grid(world, view);
    grid.bounce(strength);
    for (int v = 0; v < view.camera.height; ++v) {
        for (int u = 0; u < view.camera.width; ++u) {
            const int index = view.rectangle(u, v);
            float& inverse = view.inverse_depth(u, v);
            if (index < 0 || inverse <= 0) continue;
            const int surface = world.rectangles[static_cast<std::size_t>(index)].surface;
            const double excess = grid.excess(u, v, surface);
            const double range = view.camera.unproject(u, v, 1).norm() / static_cast<double>(inverse);
            inverse = static_cast<float>(static_cast<double>(inverse) / (1 + excess / range));
        }
    }
}

}  // namespace planemap::simulator
