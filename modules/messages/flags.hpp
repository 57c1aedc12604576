// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace planemap {

/// Adds the fields of an options struct as flags, each named --<prefix>NAME, with its default shown in
/// --help.
///   FlagAdder add(app, "segmentation-", "Segmentation");
///   add("min-inliers", options.min_inliers, "smallest region, points");
class FlagAdder {
  public:
    /// group: heading in --help.
    FlagAdder(CLI::App& app, std::string prefix, std::string group)
        : app_(app), prefix_(std::move(prefix)), group_(std::move(group)) {}

    template <typename T>
    CLI::Option* operator()(const std::string& name, T& field, const std::string& description) {
        return app_.add_option("--" + prefix_ + name, field, description)
            ->capture_default_str()
            ->group(group_);
    }

  private:
    CLI::App& app_;
    std::string prefix_, group_;
};

}  // namespace planemap
