// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace planemap::sensor {

/// How far a source was played, in a file that outlives the process.
class PositionFile {
  public:
    /// An empty path: nothing is kept.
    explicit PositionFile(std::filesystem::path file) : file_(std::move(file)) {}

    /// The stamp of the last frame that the process before played; nothing if it kept none. One that cannot
    /// be read is warned of.
    std::optional<std::int64_t> read() const;
    /// Keeps the stamp of the frame that was played last, ten times a second, with the kernel: a kill loses
    /// no more. `now_us`: the wall clock. False if it was due and could not be written.
    bool keep(std::int64_t utime, std::int64_t now_us);
    /// The source came to its end: the next process begins anew.
    void remove() const;

  private:
    std::filesystem::path file_;
    std::int64_t kept_us_ = 0;  ///< wall clock of the last time
};

}  // namespace planemap::sensor
