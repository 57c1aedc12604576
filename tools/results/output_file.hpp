// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "results/result_folder.hpp"

namespace planemap {

/// One file of results that a user names, and that comes together while a tool works: a benchmark's rows. "-"
/// is standard output, an empty name nothing at all. An earlier file stays until the new one is whole; if the
/// tool ends with an error before that, the part is set aside, and said where. Without an earlier file the
/// part bears the name.
class OutputFile {
  public:
    /// Tries that the file can be written: an error now, not in an hour. Throws std::runtime_error naming it.
    explicit OutputFile(const std::filesystem::path& file);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Where what is for people goes: standard output, unless the file takes it.
    std::FILE* for_people() const { return to_stdout_ ? stderr : stdout; }
    /// What there is so far; each call replaces the one before.
    void keep(const std::string& so_far);
    /// All there is, and for people, too. Throws std::runtime_error if it cannot be written.
    void finish(const std::string& whole);

  private:
    std::filesystem::path file_;
    bool to_stdout_ = false, is_new_ = true;
    std::unique_ptr<ResultFolder> results_;  ///< nothing for standard output, nothing at all, and devices
};

}  // namespace planemap
