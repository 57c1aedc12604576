// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace planemap {

/// A file that a tool makes and that was not there before: it comes together beside its name
/// (FOLDER/.NAME.part) and bears the name when it is whole. What is there already is never written over.
class NewFile {
  public:
    /// Throws std::runtime_error, one line that names the file, if it is there already, or its folder cannot
    /// be made or written to.
    explicit NewFile(std::filesystem::path file);
    /// Removes the part, unless it was put in place.
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    /// Where it is to be written.
    const std::filesystem::path& part() const { return part_; }
    const std::filesystem::path& path() const { return file_; }
    /// Puts the whole file in place, on the disk too. Throws std::runtime_error naming it; also if one came
    /// there meanwhile.
    void put_in_place();

  private:
    std::filesystem::path file_, part_;
};

/// The same for a folder; one that is empty counts as none.
class NewFolder {
  public:
    /// Throws as NewFile.
    explicit NewFolder(std::filesystem::path folder);
    ~NewFolder();
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    const std::filesystem::path& part() const { return part_; }
    /// Throws std::runtime_error naming it.
    void put_in_place();

  private:
    std::filesystem::path folder_, part_;
};

}  // namespace planemap
