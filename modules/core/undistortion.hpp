// SPDX-License-Identifier: BSD-3-Clause
// Images as a lens drew them to those of a pinhole with the same intrinsics.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// A camera as it senses, the pinholes that all that comes after decoding takes it for, and the maps from the
/// images of the one to those of the other, made once, when the first image comes. Without distortion it does
/// nothing. Threads may share it.
///
/// Depth is along the axis, so that a reading keeps its value and only its place is another: each pixel of
/// the pinhole takes the reading nearest to its ray, and none where that one is none. Nothing is interpolated
/// across an edge. Colour is bilinear. What the lens does not show has no depth, and the colour of the
/// image's border; hide_unseen() takes depth away there.
class Undistortion {
  public:
    /// Precondition: the camera is valid.
    explicit Undistortion(const CameraInfo& sensed);

    const CameraInfo& sensed() const { return sensed_; }    ///< of the images as they arrive
    const CameraInfo& pinhole() const { return pinhole_; }  ///< the same without distortion

    /// Of the depth camera's image, raw units.
    void undistort(DepthImage& depth) const;
    /// Of the colour camera's image.
    void undistort(GrayImage& gray) const;
    void undistort(RgbImage& color) const;
    /// Of a picture of it with one pixel for `reduction` x `reduction`: nearest pixels.
    void undistort_reduced(RgbImage& color, int reduction) const;
    /// Takes away what a depth image in the colour camera's pixels has where colour was not seen.
    void hide_unseen(DepthImage& depth_in_color) const;

  private:
    struct Mix {
        std::uint32_t index;        ///< of the upper left one of four pixels
        std::uint8_t right, below;  ///< shares of the others, of 256
    };
    struct ColorMap {
        std::vector<Mix> mixes;             ///< by pixel
        std::vector<std::uint32_t> unseen;  ///< pixels
    };
    /// Of the pinhole's pixels, where their readings are; -1: not seen.
    const std::vector<std::int32_t>& depth_map() const;
    const ColorMap& color_map() const;
    template <typename Pixel>
    void mix(Image<Pixel>& image) const;

    CameraInfo sensed_, pinhole_;
    mutable std::once_flag depth_made_, color_made_;
    mutable std::vector<std::int32_t> depth_;
    mutable ColorMap color_;
};

}  // namespace planemap
