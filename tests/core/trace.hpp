// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap::test {

/// The boundary of the set cells as rings in cell-corner coordinates: cell (x, y) is the square [x, x+1] x
/// [y, y+1]. Outer rings are counter-clockwise (in a frame with x right and y up), holes clockwise; cells
/// that touch at a corner only are separate parts. Collinear vertices are left out.
inline Outline trace(const Mask& mask) {
    // Each set cell contributes directed edges counter-clockwise around it where its neighbour is not set. An
    // edge is named by its start corner and direction (0: +x, 1: +y, 2: -x, 3: -y); following them gives the
    // rings.
    const int corners_wide = mask.width + 1;
    const auto corner = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(corners_wide) +
               static_cast<std::size_t>(x);
    };
    std::vector<std::uint8_t> edges(corner(0, mask.height + 1), 0);
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            if (!mask.at(x, y - 1)) edges[corner(x, y)] |= 1;
            if (!mask.at(x + 1, y)) edges[corner(x + 1, y)] |= 2;
            if (!mask.at(x, y + 1)) edges[corner(x + 1, y + 1)] |= 4;
            if (!mask.at(x - 1, y)) edges[corner(x, y + 1)] |= 8;
        }
    }
    constexpr std::array<int, 4> dx{1, 0, -1, 0}, dy{0, 1, 0, -1};
    Outline outline;
    for (int y = 0; y <= mask.height; ++y) {
        for (int x = 0; x <= mask.width; ++x) {
            while (edges[corner(x, y)] != 0) {
                Ring ring;
                int cx = x, cy = y, previous = -1;
                int direction = 0;
                while ((edges[corner(cx, cy)] >> direction & 1) == 0) ++direction;
                const int first = direction;
                do {
                    edges[corner(cx, cy)] =
                        static_cast<std::uint8_t>(edges[corner(cx, cy)] & ~(1 << direction));
                    if (direction != previous) ring.emplace_back(cx, cy);
                    previous = direction;
                    cx += dx[static_cast<std::size_t>(direction)];
                    cy += dy[static_cast<std::size_t>(direction)];
                    // Turn left where two rings meet at a corner: cells that touch there stay apart.
                    const std::uint8_t here = edges[corner(cx, cy)];
                    const int left = (direction + 1) % 4, right = (direction + 3) % 4;
                    if (here >> left & 1) {
                        direction = left;
                    } else if (here >> direction & 1) {
                        // straight on
                    } else if (here >> right & 1) {
                        direction = right;
                    } else {
                        break;
                    }
                } while (true);
                if (previous == first && ring.size() > 1) ring.erase(ring.begin());
                outline.rings.push_back(std::move(ring));
            }
        }
    }
    return outline;
}

}  // namespace planemap::test
