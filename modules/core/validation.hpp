// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace planemap {

/// Collects every bad field of an options struct, so that one error names them all.
///   FieldErrors errors("SegmentationOptions");
///   errors.require(min_inliers > 0, "min_inliers", min_inliers, "greater than 0");
///   errors.throw_if_any();
class FieldErrors {
  public:
    explicit FieldErrors(std::string_view what) : what_(what) {}

    void require(bool ok, std::string_view field, double value, std::string_view allowed);
    void require(bool ok, std::string_view field, std::string_view value, std::string_view allowed);

    bool any() const { return !text_.empty(); }
    /// Throws std::invalid_argument with one line: what, and for each bad field its value and what is
    /// allowed.
    void throw_if_any() const;

  private:
    std::string what_, text_;
};

}  // namespace planemap
