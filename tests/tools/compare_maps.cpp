// SPDX-License-Identifier: BSD-3-Clause
// compare_maps A B [IOU]: exit code 0 when two plane_map.lcmlog hold the same map: the same number of planes,
// at least one, each with a partner that agrees. With IOU: when each plane of A of 1 m2 and more has a
// partner in B within 0.1 m and 5 deg whose outline overlaps it by so much. Prints every pair. For tests of
// whole programs.
#include <algorithm>
#include <cstdio>
#include <set>

#include "evaluate/map_agreement.hpp"
#include "map/map_file.hpp"
#include "messages/process.hpp"

int main(int argc, char** argv) {
    return planemap::messages::run_main("compare_maps", [&] {
        if (argc != 3 && argc != 4) throw std::invalid_argument("two plane_map.lcmlog, please");
        const double smallest_iou = argc == 4 ? std::stod(argv[3]) : 0;
        const planemap::PlaneMap a = planemap::map::read_plane_map(argv[1]),
                                 b = planemap::map::read_plane_map(argv[2]);
        std::size_t missing = 0;
        std::set<int> agreeing;  // planes of B: two of A that are one there do not agree
        double worst_iou = 1;
        for (const planemap::MapPlane& plane : a.planes) {
            const planemap::test::Agreement found = planemap::test::best_agreement(plane, b);
            const bool agrees = found.is_within({});
            if (agrees) agreeing.insert(found.id_b);
            missing += plane.area >= 1 && !found.is_within({0.1, 5, smallest_iou});
            worst_iou = std::min(worst_iou, found.iou);
            std::printf("%s plane %d of %.2f m2: partner %d, %.4f m, %.3f deg, IoU %.3f\n",
                        agrees ? "same" : "DIFFERS", plane.id, static_cast<double>(plane.area), found.id_b,
                        found.distance_m, found.angle_deg, found.iou);
        }
        std::printf("%zu and %zu planes, %zu agree, smallest IoU %.3f\n", a.planes.size(), b.planes.size(),
                    agreeing.size(), worst_iou);
        if (argc == 4) return !a.planes.empty() && missing == 0 ? 0 : 1;
        return !a.planes.empty() && a.planes.size() == b.planes.size() && agreeing.size() == a.planes.size()
                   ? 0
                   : 1;
    });
}
