// SPDX-License-Identifier: BSD-3-Clause
// compare_maps A B: exit code 0 when two plane_map.lcmlog hold the same map: the same number of planes, at
// least one, each with a partner that agrees. Prints every pair. For tests of whole programs.
#include <cstdio>

#include "evaluate/map_agreement.hpp"
#include "map/map_file.hpp"
#include "messages/process.hpp"

int main(int argc, char** argv) {
    return planemap::messages::run_main("compare_maps", [&] {
        if (argc != 3) throw std::invalid_argument("two plane_map.lcmlog, please");
        const planemap::PlaneMap a = planemap::map::read_plane_map(argv[1]),
                                 b = planemap::map::read_plane_map(argv[2]);
        std::size_t agree = 0;
        double worst_iou = 1;
        for (const planemap::PlanePair& pair : planemap::pair_planes(a, b)) {
            const bool agrees = pair.agrees({});
            agree += agrees;
            worst_iou = std::min(worst_iou, pair.iou);
            std::printf("%s plane %d of %.2f m2: partner %d, %.4f m, %.3f deg, IoU %.3f\n",
                        agrees ? "same" : "DIFFERS", pair.id_a, pair.area_m2, pair.id_b, pair.distance_m,
                        pair.angle_deg, pair.iou);
        }
        std::printf("%zu and %zu planes, %zu agree, smallest IoU %.3f\n", a.planes.size(), b.planes.size(),
                    agree, worst_iou);
        return !a.planes.empty() && a.planes.size() == b.planes.size() && agree == a.planes.size() ? 0 : 1;
    });
}
