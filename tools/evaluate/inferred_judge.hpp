// SPDX-License-Identifier: BSD-3-Clause
// What a map infers that nobody saw, beside what is there.
#pragma once

#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "evaluate/plane_judge.hpp"

namespace planemap::evaluation {

struct InferredJudgement {
    double area_m2 = 0;   ///< of all inferred parts
    double right_m2 = 0;  ///< of those, what lies on a true plane, seen or not

    /// Share; nothing where nothing is inferred.
    std::optional<double> right() const;
};

/// Holds inferred parts against the true planes: right is what lies within 5 cm (and 10 deg) of one, where
/// that is. `truth_from_map` lays the map's world on the truth's.
InferredJudgement judge_inferred(const std::vector<TruePlane>& truth, const PlaneMap& map,
                                 const Pose& truth_from_map);

}  // namespace planemap::evaluation
