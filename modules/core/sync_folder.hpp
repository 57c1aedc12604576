// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace planemap {

/// Waits until a folder's entries are on the disk: a name that was given or taken in it outlives a power cut.
/// Returns errno of what failed; 0 if nothing did, or the file system cannot sync a folder.
inline int sync_folder(const std::filesystem::path& folder) {
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool failed = handle < 0 || ::fsync(handle) != 0;
    const int error = failed ? errno : 0;
    if (handle >= 0) ::close(handle);
    return error == EINVAL ? 0 : error;
}

}  // namespace planemap
