// SPDX-License-Identifier: BSD-3-Clause
#include "map/earlier_map.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "core/stamp.hpp"

namespace planemap::map {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKept = 5;

/// Those with the stem, the oldest first: their names tell the date.
std::vector<fs::path> kept_beside(const fs::path& file, const std::string& stem) {
    std::error_code error;
    std::vector<fs::path> found;
    for (fs::directory_iterator at(file.parent_path(), error), end; !error && at != end;
         at.increment(error)) {
        if (at->path().filename().string().starts_with(stem) && at->path().extension() == file.extension())
            found.push_back(at->path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// A second name for the file. Where the file system knows no second names, the first one is given up:
/// between this and the write that follows there is none with it.
void name_or_throw(const fs::path& file, const fs::path& kept) {
    std::error_code error;
    fs::create_hard_link(file, kept, error);
    if (error) fs::rename(file, kept, error);
    if (error) throw std::system_error(error, file.string() + ": cannot be kept as " + kept.string());
}

}  // namespace

KeptMap keep_earlier_map(const fs::path& file) {
    const std::string stem = file.stem().string() + ".earlier-";
    struct stat status = {};
    if (::stat(file.c_str(), &status) != 0)
        throw std::system_error(errno, std::generic_category(), file.string() + ": cannot be kept");
    KeptMap kept;
    for (int i = 1;; ++i) {
        kept.file = file.parent_path() /
                    (stem + date_text(status.st_mtime) + "-" + std::to_string(i) + file.extension().string());
        std::error_code ignored;
        if (fs::equivalent(file, kept.file, ignored)) return kept;  // before a write that failed
        if (!fs::exists(fs::symlink_status(kept.file, ignored))) break;
    }
    name_or_throw(file, kept.file);
    const std::vector<fs::path> all = kept_beside(file, stem);
    for (std::size_t i = 0; i + kKept < all.size(); ++i) {
        std::error_code failed;
        if (fs::remove(all[i], failed)) kept.removed.push_back(all[i]);
    }
    return kept;
}

}  // namespace planemap::map
