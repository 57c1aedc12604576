// SPDX-License-Identifier: BSD-3-Clause
// A segmentation against the true planes of its image.
#pragma once

#include <vector>

#include "segmentation/segmenter.hpp"

namespace planemap::bench {

/// One connected piece (4 neighbours) of a true surface in the image.
struct TruePiece {
    int surface = 0;    ///< pieces of the same surface lie on the same plane
    double pixels = 0;  ///< with a valid reading
    Plane plane;        ///< depth camera's frame, normal towards the sensor
};

/// The true surfaces of one depth image.
struct Truth {
    Image<std::uint16_t> pieces_of_pixels;  ///< size of the depth image; 0: none, i + 1: pieces[i]
    std::vector<TruePiece> pieces;
};

/// Cuts surfaces into connected pieces. `surfaces` holds 0 for none, or i + 1 for planes[i]; pixels without a
/// trusted reading carry no truth. At most 65535 pieces: further ones are none.
Truth make_truth(const Image<std::uint16_t>& surfaces, const std::vector<Plane>& planes,
                 const DepthImage& depth, const CameraInfo& camera);

/// What came of the true pieces and of the found regions; adds up over frames.
///
/// A true region is a piece, or several pieces of one surface that the same found region covers by more than
/// half each: a wall seen left and right of a pillar may be returned as one region or as two. A found region
/// and a true region match when the intersection of their pixels is at least 0.8 of their union. Only pieces
/// of at least `least_pixels` can be missed, and only found regions of at least that many can be false.
///
/// The five counts are those of the SegComp range image comparison (Hoover et al. 1996) at a tolerance of 80
/// %; an instance counts once, as correct before over- before under-segmented.
struct MatchScore {
    int true_pieces = 0, recalled = 0;  ///< pieces of at least least_pixels; of these: matched
    int found = 0, precise = 0;         ///< found regions of at least least_pixels; of these: matched
    int correct = 0, over_segmented = 0, under_segmented = 0, missed = 0;  ///< true pieces, sum: true_pieces
    int noise = 0;                   ///< found regions that take part in none of the first three
    std::vector<double> angle_deg;   ///< of each match with a large piece: found to true normal
    std::vector<double> distance_m;  ///< of each such match: found plane to the true centroid

    MatchScore& operator+=(const MatchScore& o);
    double recall() const { return true_pieces > 0 ? static_cast<double>(recalled) / true_pieces : 0; }
    double precision() const { return found > 0 ? static_cast<double>(precise) / found : 0; }
};

/// Compares one frame. Found pixels without truth or without a trusted reading count against a found region
/// only if the reading is trusted.
MatchScore match(const Truth& truth, const segmentation::Segmentation& segmentation, const DepthImage& depth,
                 const CameraInfo& camera, double least_pixels);

}  // namespace planemap::bench
