// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/folder_lock.hpp"

namespace planemap {

/// One file of results: its name in the folder, and what writes it to the path it is given.
struct Result {
    std::string name;
    std::function<void(const std::filesystem::path&)> write;
};

/// A folder of results that replaces an earlier one as a whole.
///
/// Results are made in a workspace inside the folder (FOLDER/.partial) and moved to their names together when
/// they are all there; until then the earlier ones are untouched. A kill while they are moved is made good by
/// the next ResultFolder there. What a run that did not end left in its workspace is set aside as
/// FOLDER/partial-DATE-N (UTC, when it was last written), so that nothing is lost; of these the newest five
/// are kept, so that they do not pile up. One process at a time works with a workspace (FolderLock). Files
/// under other names are never touched.
class ResultFolder {
  public:
    enum class Leftovers { kSetAside, kRemove };

    /// Makes the folder, takes the lock, and tries that there is room, so that an error that can be seen at
    /// the start is not seen after an hour. `names` are what the tool may write there. Throws
    /// std::runtime_error with one line if the folder cannot be made or written to, another run works in it,
    /// or one of the names is a folder.
    ResultFolder(std::filesystem::path folder, std::vector<std::string> names,
                 std::string workspace_name = ".partial", Leftovers leftovers = Leftovers::kSetAside);
    /// Gives the lock back; a workspace with something in it stays, for the next run to name.
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    /// What the user should know, a line each, since the last call: earlier runs' leftovers and their fate.
    std::vector<std::string> take_notes();

    /// Makes a result in the workspace; if it is there already, anew. A folder that went away is made again.
    /// Throws what `write` throws; an earlier state of the result is then still there.
    void make(const Result& result);
    /// The file in the workspace, whether or not it is there.
    std::filesystem::path made(const std::string& name) const { return workspace() / name; }
    /// True if the workspace holds something.
    bool holds_made() const;
    /// True if the folder holds a result under one of the names.
    bool holds_earlier() const;

    /// Puts what was made in place, and removes earlier results under those of `names` that were not made
    /// (all names of the constructor, if none are given). Throws std::runtime_error naming the file, before
    /// anything is touched if something that was made is not there any more.
    void replace(const std::vector<std::string>& names = {});
    /// Keeps what was made as a folder of its own beside the earlier results; returns where.
    std::filesystem::path set_aside();
    /// Removes what was made.
    void discard();

  private:
    std::filesystem::path workspace() const { return folder_ / workspace_; }
    std::filesystem::path moving() const { return folder_ / (workspace_ + "-whole"); }
    std::filesystem::path lock_file() const { return folder_ / (workspace_ + ".lock"); }
    void enter();
    void go_beside(const std::string& why);
    void restore();
    void try_room() const;
    void remove_scraps() const;
    void move_into_place();
    std::string aside_stem() const;

    std::filesystem::path folder_;
    std::vector<std::string> names_;
    std::string workspace_;
    std::vector<std::string> made_, notes_;
    FolderLock lock_;
};

}  // namespace planemap
