// SPDX-License-Identifier: BSD-3-Clause
#include "results/result_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/files.hpp"
#include "core/stamp.hpp"
#include "core/sync_folder.hpp"

namespace planemap {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeptAside = 5;
constexpr std::size_t kTriedBytes = 1 << 16;
constexpr const char* kStale = ".stale-";  ///< marks a name whose earlier result goes

[[noreturn]] void fail(const fs::path& path, const std::string& what, const std::string& reason) {
    throw std::runtime_error(path.string() + ": " + what + ": " + reason);
}

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) fail(to, "cannot be put in place", error.message());
}

void remove_or_throw(const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    if (error) fail(path, "cannot be removed", error.message());
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> entries;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        entries.push_back(at->path());
    if (error) fail(folder, "cannot be read", error.message());
    std::sort(entries.begin(), entries.end());
    return entries;
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// What is no result: trials, marks, and what a kill leaves of write_file().
bool is_scrap(const fs::path& file) {
    const std::string name = file.filename().string();
    const std::size_t tmp = name.rfind(".tmp");
    return name.starts_with('.') || (tmp != std::string::npos && is_number(name.substr(tmp + 4)));
}

/// When something in the folder was last written: 20261128-180501, UTC.
std::string date_of(const fs::path& folder) {
    std::time_t newest = 0;
    struct stat status = {};
    if (::stat(folder.c_str(), &status) == 0) newest = status.st_mtime;
    for (const fs::path& entry : entries_of(folder))
        if (::stat(entry.c_str(), &status) == 0) newest = std::max(newest, status.st_mtime);
    return date_text(newest);
}

/// What a run that did not end left, set aside.
struct Aside {
    std::string date;
    int number;
    fs::path path;
};

/// The folders of set_aside(), the oldest first: by date, then by the number that tells those of one second.
std::vector<Aside> asides_in(const fs::path& folder, const std::string& stem) {
    // YYYYMMDD-HHMMSS-N
    constexpr std::size_t kDay = 8, kDate = 15, kMostDigits = 9;
    std::vector<Aside> found;
    for (const fs::path& entry : entries_of(folder)) {
        const std::string name = entry.filename().string();
        if (!name.starts_with(stem)) continue;
        const std::string rest = name.substr(stem.size());
        if (rest.size() <= kDate + 1 || rest.size() > kDate + 1 + kMostDigits) continue;
        const std::string date = rest.substr(0, kDate), number = rest.substr(kDate + 1);
        if (rest[kDay] == '-' && rest[kDate] == '-' && is_number(date.substr(0, kDay)) &&
            is_number(date.substr(kDay + 1)) && is_number(number))
            found.push_back({date, std::stoi(number), entry});
    }
    std::sort(found.begin(), found.end(), [](const Aside& a, const Aside& b) {
        return std::tie(a.date, a.number) < std::tie(b.date, b.number);
    });
    return found;
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, std::vector<std::string> names, std::string workspace_name,
                           Leftovers leftovers)
    : folder_(std::move(folder)),
      names_(std::move(names)),
      workspace_(std::move(workspace_name)),
      lock_(workspace_ + ".lock") {
    // A limit on the size of files (ulimit -f) is then an error of the write, not the end of the process.
    std::signal(SIGXFSZ, SIG_IGN);
    for (const std::string& name : names_) {
        std::error_code error;
        const fs::file_status there = fs::status(folder_ / name, error);
        if (fs::exists(there) && !fs::is_regular_file(there)) {
            throw std::runtime_error((folder_ / name).string() + ": is " +
                                     (fs::is_directory(there) ? "a folder" : "no file") +
                                     ", where a result is to go");
        }
    }
    if (!lock_.take(folder_)) {
        throw std::runtime_error(folder_.string() +
                                 ": another run is writing its results there (its lock is " +
                                 lock_file().filename().string() + "): wait for it, or give another folder");
    }
    if (!lock_.unsupported().empty())
        notes_.push_back(folder_.string() + ": its file system knows no locks (" + lock_.unsupported() +
                         "): nothing keeps a run on another computer out of it");
    try {
        restore();
        remove_scraps();
        if (leftovers == Leftovers::kRemove && holds_made()) {
            remove_or_throw(workspace());
            notes_.push_back(workspace().string() + ": left by a run that did not end; removed");
        } else if (holds_made()) {
            const fs::path kept = set_aside();
            notes_.push_back("an earlier run that did not end left what it had so far: kept as " +
                             kept.string());
        }
        try_room();
    } catch (...) {
        lock_.release();
        throw;
    }
}

ResultFolder::~ResultFolder() {
    std::error_code ignored;
    if (lock_.state() == FolderLock::State::kHeld)
        fs::remove(workspace(), ignored);  // succeeds only if it is empty
}

std::vector<std::string> ResultFolder::take_notes() {
    return std::exchange(notes_, {});
}

/// Sees to it that the folder is there and ours. One that was removed meanwhile is made again; if something
/// else has taken its place, the results go into a folder beside it.
void ResultFolder::enter() {
    using State = FolderLock::State;
    const State state = lock_.state();
    if (state == State::kHeld) return;
    if (state == State::kNoFolder) return go_beside("is no folder any more");
    if (state == State::kTaken || !lock_.retake()) return go_beside("another run has taken it");
    const bool only_file = state == State::kFileRemoved;
    notes_.push_back((only_file ? lock_file() : folder_).string() + ": was removed meanwhile; made again");
    if (!only_file) made_.clear();
}

void ResultFolder::go_beside(const std::string& why) {
    const fs::path wanted = folder_;
    for (int i = 2;; ++i) {
        folder_ = wanted.string() + "-" + std::to_string(i);
        if (is_there(folder_) && (!fs::is_directory(folder_) || !entries_of(folder_).empty())) continue;
        if (lock_.take(folder_)) break;
    }
    made_.clear();
    notes_.push_back(wanted.string() + ": " + why + "; the results go to " + folder_.string());
}

/// Ends what an earlier run began: its results were whole, but not all in place.
void ResultFolder::restore() {
    if (!is_there(moving())) return;
    move_into_place();
    notes_.push_back(folder_.string() +
                     ": put the results of an earlier run in place, which was ended in doing so");
}

void ResultFolder::try_room() const {
    std::error_code error;
    fs::create_directory(workspace(), error);
    if (error) fail(workspace(), "cannot be made", error.message());
    const fs::path trial = workspace() / ".trial";
    write_file(trial, std::string(kTriedBytes, ' '));
    fs::remove(trial, error);
}

void ResultFolder::make(const Result& result) {
    enter();
    std::error_code error;
    fs::create_directory(workspace(), error);
    if (error) fail(workspace(), "cannot be made", error.message());
    result.write(made(result.name));
    if (std::find(made_.begin(), made_.end(), result.name) == made_.end()) made_.push_back(result.name);
}

bool ResultFolder::holds_made() const {
    if (!is_there(workspace())) return false;
    const std::vector<fs::path> entries = entries_of(workspace());
    return !std::all_of(entries.begin(), entries.end(), is_scrap);
}

void ResultFolder::remove_scraps() const {
    if (!is_there(workspace())) return;
    for (const fs::path& entry : entries_of(workspace()))
        if (is_scrap(entry)) remove_or_throw(entry);
}

bool ResultFolder::holds_earlier() const {
    return std::any_of(names_.begin(), names_.end(),
                       [&](const std::string& name) { return is_there(folder_ / name); });
}

void ResultFolder::replace(const std::vector<std::string>& names) {
    for (const std::string& name : made_)
        if (!is_there(made(name))) fail(made(name), "was made, and is gone", "the earlier results stay");
    for (const std::string& name : names.empty() ? names_ : names) {
        // The marks tell who goes on after a kill what else there is to do.
        if (is_there(folder_ / name) && !is_there(made(name))) write_file(workspace() / (kStale + name), "");
    }
    if (!is_there(workspace())) return;  // nothing was made
    rename_or_throw(workspace(), moving());
    move_into_place();
    made_.clear();
}

void ResultFolder::move_into_place() {
    for (const fs::path& entry : entries_of(moving())) {
        const std::string name = entry.filename().string();
        if (name.starts_with(kStale)) {
            remove_or_throw(folder_ / name.substr(std::strlen(kStale)));
            remove_or_throw(entry);
        } else {
            rename_or_throw(entry, folder_ / name);
        }
    }
    remove_or_throw(moving());
    sync_folder(folder_);  // where that cannot be had, nothing is lost by it
}

std::string ResultFolder::aside_stem() const {
    return (workspace_.starts_with('.') ? workspace_.substr(1) : workspace_) + "-";
}

fs::path ResultFolder::set_aside() {
    const std::string date = date_of(workspace());
    int number = 1;
    for (const Aside& aside : asides_in(folder_, aside_stem()))
        if (aside.date == date) number = aside.number + 1;
    const fs::path kept = folder_ / (aside_stem() + date + "-" + std::to_string(number));
    remove_scraps();
    rename_or_throw(workspace(), kept);
    made_.clear();
    const std::vector<Aside> all = asides_in(folder_, aside_stem());
    for (std::size_t i = 0; i + kKeptAside < all.size(); ++i) {
        remove_or_throw(all[i].path);
        notes_.push_back(all[i].path.string() + ": removed, the newest " + std::to_string(kKeptAside) +
                         " of its kind are kept");
    }
    return kept;
}

void ResultFolder::discard() {
    remove_or_throw(workspace());
    made_.clear();
}

}  // namespace planemap
