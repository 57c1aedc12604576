// SPDX-License-Identifier: BSD-3-Clause
#include "results/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace planemap {

namespace {

namespace fs = std::filesystem;

void close_handle(int& handle) {
    if (handle >= 0) ::close(std::exchange(handle, -1));
}

/// True if the path leads to what the handle is of. While a handle is open its inode's number is not used
/// anew.
bool is_at(int handle, const fs::path& path) {
    struct stat ours = {}, there = {};
    return handle >= 0 && ::fstat(handle, &ours) == 0 && ::stat(path.c_str(), &there) == 0 &&
           ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

}  // namespace

bool FolderLock::take(const fs::path& folder) {
    release();
    folder_ = folder;
    make_folder();
    if (take_name() && take_file()) return true;
    release();
    return false;
}

bool FolderLock::retake() {
    make_folder();
    return take_file();
}

void FolderLock::make_folder() const {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw std::runtime_error(folder_.string() + ": cannot be made: " + error.message());
    if (!fs::is_directory(folder_, error))
        throw std::runtime_error(folder_.string() + ": is no folder that can be written to");
}

bool FolderLock::take_file() {
    close_handle(file_);
    close_handle(folder_handle_);
    while (true) {
        switch (try_file()) {
            case Taken::kOurs:
                folder_handle_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
                return true;
            case Taken::kOthers:
                close_handle(file_);
                return false;
            case Taken::kAgain:
                close_handle(file_);
        }
    }
}

FolderLock::Taken FolderLock::try_file() {
    file_ = ::open(file().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) {
        throw std::runtime_error(folder_.string() +
                                 ": is no folder that can be written to: " + std::strerror(errno));
    }
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) return Taken::kAgain;
        if (errno == EWOULDBLOCK) return Taken::kOthers;
        unsupported_ = std::strerror(errno);
        return Taken::kOurs;
    }
    return is_at(file_, file()) ? Taken::kOurs : Taken::kAgain;  // its last holder has just removed it
}

/// False if another process has the name. Where there are no such sockets, the file is the only lock.
bool FolderLock::take_name() {
    std::error_code error;
    const fs::path real = fs::canonical(folder_, error);
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    // The first byte is 0: a name without a file. Paths may be longer than it, hashes are not.
    const int length =
        std::snprintf(address.sun_path + 1, sizeof(address.sun_path) - 1, "planemap-results-%016zx",
                      std::hash<std::string>()((error ? folder_ : real).string() + '\n' + file_name_));
    name_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const auto size =
        static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + static_cast<std::size_t>(length));
    return name_ < 0 || ::bind(name_, reinterpret_cast<const sockaddr*>(&address), size) == 0 ||
           errno != EADDRINUSE;
}

void FolderLock::release() {
    if (is_at(file_, file())) ::unlink(file().c_str());
    close_handle(file_);
    close_handle(folder_handle_);
    close_handle(name_);
}

FolderLock::State FolderLock::state() const {
    if (is_at(file_, file())) return State::kHeld;
    std::error_code error;
    const fs::file_status status = fs::status(folder_, error);
    if (fs::exists(status) && !fs::is_directory(status)) return State::kNoFolder;
    if (!fs::exists(status)) return State::kFolderRemoved;
    const int others = ::open(file().c_str(), O_RDWR | O_CLOEXEC);
    const bool taken = others >= 0 && ::flock(others, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (others >= 0) ::close(others);
    if (taken) return State::kTaken;
    return is_at(folder_handle_, folder_) ? State::kFileRemoved : State::kFolderRemoved;
}

}  // namespace planemap
