// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"

namespace planemap::odometry {

/// Whether depth lies where colour sees it. The silhouettes of depth, where one surface hides another, are
/// held against the steps in brightness beside them, over some frames: where these lie displaced, by a shift
/// and a stretch along the rows that are the same for all, and not where they should, depth is taken for
/// unregistered. A scene without silhouettes, or whose silhouettes cannot be seen, says nothing; nor does a
/// displacement of a few pixels, which is what sensors err by.
class RegistrationCheck {
  public:
    /// Looks at a frame if it is half a second after the last one looked at, until it has seen enough: true
    /// if it has with this one. `depth` and `gray` are of the colour camera's pixels.
    bool see(std::int64_t utime, const DepthImage& depth, const GrayImage& gray);

    /// By how much the steps lie beside the silhouettes along the rows, in pixels of the colour camera.
    struct Displacement {
        double shift_px = 0;             ///< in the middle of the image; to the right
        double stretch_px = 0;           ///< from its left to its right edge
        double clearness = 0;            ///< of the steps there, over the steps anywhere: 1 is none
        double clearness_elsewhere = 0;  ///< the next best, of displacements that are another
        /// Largest in the image.
        double most_px() const;
    };
    /// Nothing before enough was seen.
    std::optional<Displacement> displacement() const;
    /// A line if depth looks unregistered; nothing if not, or before enough was seen.
    std::optional<std::string> complaint() const;

  private:
    static constexpr int kFrames = 20, kColumns = 16, kReach = 64;

    void vote(const GrayImage& gray, int u, int v);
    double steps_at(double shift_px, double stretch_px) const;

    std::int64_t last_utime_ = 0;
    int seen_ = 0;  ///< frames
    int silhouettes_ = 0;
    /// By column of the image and displacement: the mean step of brightness there, over that anywhere near.
    std::vector<double> steps_ = std::vector<double>(static_cast<std::size_t>(kColumns * (2 * kReach + 1)));
    std::vector<int> counts_ = std::vector<int>(static_cast<std::size_t>(kColumns));
};

}  // namespace planemap::odometry
