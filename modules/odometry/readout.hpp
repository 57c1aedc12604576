// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "odometry/alignment.hpp"

namespace planemap::odometry {

/// How long the camera takes to read an image out, learnt from what it sees while it moves: with a rolling
/// shutter the rows of an image are seen one after the other, and a turning camera sees straight things bent.
/// Neither drivers nor calibrations tell it. A global shutter is learnt as 0.
class Readout {
  public:
    /// Seconds from the first row to the last; negative when rows are read from below.
    double seconds() const;
    /// Takes in a frame that was aligned with the readout `used_s`.
    void learn(double used_s, const AlignmentResult& result);

  private:
    // That there is none is known as well as one frame of a slow turn would tell.
    static constexpr double kSigma = 1e-3;  ///< seconds
    double information_ = 1 / (kSigma * kSigma), moment_ = 0;
};

}  // namespace planemap::odometry
