// SPDX-License-Identifier: BSD-3-Clause
// What the simulated worlds are made of.
#pragma once

#include "simulator/world.hpp"

namespace planemap::simulator {

inline const Eigen::Vector3d kEast = Eigen::Vector3d::UnitX(), kNorth = Eigen::Vector3d::UnitY(),
                             kUp = Eigen::Vector3d::UnitZ();
inline const Eigen::Vector3d kWest = -kEast, kSouth = -kNorth, kDown = -kUp;

inline constexpr Look kWhite{Pattern::kPaint, {0.86f, 0.85f, 0.81f}};
inline constexpr Look kYellow{Pattern::kPaint, {0.84f, 0.78f, 0.62f}};
inline constexpr Look kBlue{Pattern::kPaint, {0.58f, 0.67f, 0.76f}};
inline constexpr Look kGrey{Pattern::kMetal, {0.66f, 0.67f, 0.68f}};
inline constexpr Look kBeech{Pattern::kWood, {0.76f, 0.60f, 0.42f}};
inline constexpr Look kOak{Pattern::kWood, {0.58f, 0.42f, 0.27f}};
inline constexpr Look kPoster{Pattern::kPoster, {0.92f, 0.91f, 0.88f}};
inline constexpr Look kScreen{Pattern::kScreen, {}};
inline constexpr Look kBooks{Pattern::kBooks, {}};
inline constexpr Look kPlastic{Pattern::kPaint, {0.20f, 0.20f, 0.22f}};
inline constexpr Look kFloorTiles{Pattern::kTiles, {0.62f, 0.63f, 0.60f}};
inline constexpr Look kCeilingBoards{Pattern::kPanels, {0.86f, 0.87f, 0.88f}};

}  // namespace planemap::simulator
