// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace planemap {

/// Sees to it that one process at a time writes results in a folder. Two locks, which go with the process,
/// however it ends:
/// - flock(2) on a file in the folder. It holds for whoever sees the folder, tools/launch included, and goes
///   when somebody removes the file or the folder.
/// - a socket's abstract name made of the folder's path. It outlasts what happens to the folder, and holds
/// for
///   the processes of this machine that share a network namespace.
class FolderLock {
  public:
    /// What became of the folder and the file since take().
    enum class State {
        kHeld,
        kFileRemoved,    ///< the folder is the same, the file is gone
        kFolderRemoved,  ///< there is none, or another one, with no lock of another process in it
        kNoFolder,       ///< something else bears its name
        kTaken,          ///< another process has put its lock there
    };

    /// `file_name` is that of the lock's file in the folder.
    explicit FolderLock(std::string file_name) : file_name_(std::move(file_name)) {}
    ~FolderLock() { release(); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Makes the folder where it is not there, and locks it; false if another process holds it. What was
    /// taken before is released. Throws std::runtime_error naming the folder if it cannot be made or written
    /// to.
    bool take(const std::filesystem::path& folder);
    /// Makes folder and file again after their removal, the name still held; false if another process was
    /// faster. Throws as take().
    bool retake();
    void release();

    State state() const;
    /// Why the folder's file system knows no locks; empty if it does.
    const std::string& unsupported() const { return unsupported_; }

  private:
    enum class Taken { kOurs, kOthers, kAgain };
    std::filesystem::path file() const { return folder_ / file_name_; }
    void make_folder() const;
    bool take_name();
    bool take_file();
    Taken try_file();

    std::string file_name_, unsupported_;
    std::filesystem::path folder_;
    int file_ = -1, name_ = -1, folder_handle_ = -1;
};

}  // namespace planemap
