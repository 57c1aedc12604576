// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace planemap::map {

/// What a mapper left out, by the reason.
struct MapLosses {
    std::size_t regions_refused = 0;   ///< not valid, without a plane, or larger or farther than can be seen
    std::size_t regions_too_many = 0;  ///< of one keyframe, after the 256th
    std::size_t regions_too_far = 0;   ///< more than 100 km from the world's origin
    std::size_t planes_refused = 0;    ///< of start_from()
    std::size_t poses_refused = 0;     ///< of trajectories: no pose, or more than 100 km away
    std::size_t keyframes_unplaced = 0;   ///< that waited for a pose while 4096 newer ones came
    std::size_t keyframes_again = 0;      ///< with the id and time of one that came before
    std::size_t keyframes_too_late = 0;   ///< that came again after they were folded
    std::size_t keyframes_far_ahead = 0;  ///< with an id more than 10,000 after the largest one
    std::size_t keyframes_of_others = 0;  ///< with the id of one in the map, and another time
    std::size_t looks_refused = 0;        ///< of a keyframe or a state that is not known

    MapLosses& operator+=(const MapLosses& other);
};

inline MapLosses& MapLosses::operator+=(const MapLosses& other) {
    for (const auto count :
         {&MapLosses::regions_refused, &MapLosses::regions_too_many, &MapLosses::regions_too_far,
          &MapLosses::planes_refused, &MapLosses::poses_refused, &MapLosses::keyframes_unplaced,
          &MapLosses::keyframes_again, &MapLosses::keyframes_too_late, &MapLosses::keyframes_far_ahead,
          &MapLosses::keyframes_of_others, &MapLosses::looks_refused})
        this->*count += other.*count;
    return *this;
}

}  // namespace planemap::map
