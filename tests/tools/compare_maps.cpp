// SPDX-License-Identifier: BSD-3-Clause
// compare_maps A B [IOU]: exit code 0 when two plane_map.lcmlog hold the same map: the same number of planes,
// at least one, each with a partner that agrees. With IOU: when each plane of A of 1 m2 and more has a
// partner in B within 0.1 m and 5 deg whose outline overlaps it by so much. Prints every pair. For tests of
// whole programs.
#include <cstdio>

#include "evaluate/map_agreement.hpp"
#include "map/map_file.hpp"
#include "messages/process.hpp"

int main(int argc, char** argv) {
    return planemap::messages::run_main("compare_maps", [&] {
        if (argc != 3 && argc != 4) throw std::invalid_argument("two plane_map.lcmlog, please");
        const double smallest_iou = argc == 4 ? std::stod(argv[3]) : 0;
        const planemap::PlaneMap a = planemap::map::read_plane_map(argv[1]),
                                 b = planemap::map::read_plane_map(argv[2]);
        std::size_t agree = 0, missing = 0;
        double worst_iou = 1;
        for (const planemap::PlanePair& pair : planemap::pair_planes(a, b)) {
            const bool agrees = pair.agrees({});
            agree += agrees;
            const bool is_there =
                pair.id_b >= 0 && pair.distance_m <= 0.1 && pair.angle_deg <= 5 && pair.iou >= smallest_iou;
            missing += pair.id_a >= 0 && pair.area_m2 >= 1 && !is_there;
            worst_iou = std::min(worst_iou, pair.iou);
            std::printf("%s plane %d of %.2f m2: partner %d, %.4f m, %.3f deg, IoU %.3f\n",
                        agrees ? "same" : "DIFFERS", pair.id_a, pair.area_m2, pair.id_b, pair.distance_m,
                        pair.angle_deg, pair.iou);
        }
        std::printf("%zu and %zu planes, %zu agree, smallest IoU %.3f\n", a.planes.size(), b.planes.size(),
                    agree, worst_iou);
        if (argc == 4) return !a.planes.empty() && missing == 0 ? 0 : 1;
        return !a.planes.empty() && a.planes.size() == b.planes.size() && agree == a.planes.size() ? 0 : 1;
    });
}
