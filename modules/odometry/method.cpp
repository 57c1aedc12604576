// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/method.hpp"

#include "odometry/paper_method.hpp"
#include "odometry/planar_method.hpp"

namespace planemap::odometry {

std::unique_ptr<Method> make_method(const OdometryOptions& options) {
    if (options.method == "paper") return std::make_unique<PaperMethod>(options);
    return std::make_unique<PlanarMethod>(options);
}

}  // namespace planemap::odometry
