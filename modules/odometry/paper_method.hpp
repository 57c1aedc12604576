// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "odometry/method.hpp"
#include "odometry/options.hpp"

namespace planemap::odometry {

/// The paper's way (section 2): features on planes, projected onto them, matched with the last frame's; the
/// motion by RANSAC, refined on its inliers; poses by chaining, taken as measured. A frame whose motion is
/// not found is looked for among the known keyframes.
class PaperMethod : public Method {
  public:
    explicit PaperMethod(const OdometryOptions& options) : options_(options) {}

    std::optional<Located> locate(const PreparedFrame& frame, const References& known) override;
    bool wants_keyframe(const PreparedFrame&, const Located&, const LocalKeyframe&) const override {
        return false;
    }

    void begin(const PreparedFrame&) override {}
    void follow(const PreparedFrame&, const Located&, double) override {}
    void lose() override { last_.clear(); }

    void go_on_from(PreparedFrame&, const Track&) override {}
    void go_on_from(PreparedFrame& frame, const LocalKeyframe& keyframe) override;

  private:
    std::optional<Track> track(const std::vector<Feature>& features, const PreparedFrame& frame,
                               const References& known) const;
    std::vector<Feature> planar_features(const PreparedFrame& frame) const;

    OdometryOptions options_;
    std::vector<Feature> last_;  ///< planar ones of the last frame
};

}  // namespace planemap::odometry
