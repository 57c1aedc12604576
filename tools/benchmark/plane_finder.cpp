// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/plane_finder.hpp"

#include "benchmark/decimation.hpp"
#include "messages/module_status.hpp"

namespace planemap::benchmark {

double timed_find(Finder& finder, const DepthImage& depth, const CameraInfo& camera, int step) {
    const double start_ms = messages::thread_cpu_ms();
    if (step == 1) {
        finder.find(depth, camera);
    } else {
        finder.find(decimated(depth, step), decimated(camera, step));
    }
    return messages::thread_cpu_ms() - start_ms;
}

}  // namespace planemap::benchmark
