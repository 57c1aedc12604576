// SPDX-License-Identifier: BSD-3-Clause
#include "results/new_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace planemap {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw std::runtime_error(file.string() + ": " + reason);
}

/// An empty folder may stand where a folder is to go: renaming replaces it.
void require_absent(const std::filesystem::path& file, bool is_folder = false) {
    std::error_code ignored;
    if (is_folder && std::filesystem::is_directory(file, ignored) && std::filesystem::is_empty(file, ignored))
        return;
    if (std::filesystem::exists(std::filesystem::symlink_status(file, ignored)))
        fail(file, "is there already, and is not written over: give another --output");
}

/// The name beside, in a folder that is made if it is not there.
std::filesystem::path part_beside(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail(folder, "cannot be made: " + error.message());
    return folder / ("." + file.filename().string() + "." + std::to_string(::getpid()) + ".part");
}

void sync(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!synced) fail(file, std::string("cannot be written: ") + std::strerror(error));
}

}  // namespace

NewFile::NewFile(std::filesystem::path file) : file_(std::move(file)) {
    if (file_.filename().empty()) fail(file_, "is a folder; --output is the file to write");
    require_absent(file_);
    part_ = part_beside(file_);
    if (!std::ofstream(part_)) fail(file_, std::string("cannot be written: ") + std::strerror(errno));
}

NewFile::~NewFile() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

void NewFile::put_in_place() {
    sync(part_);
    if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE) != 0) {
        if (errno == EEXIST) require_absent(file_);
        // File systems that do not know the flag.
        if (errno != EINVAL && errno != ENOSYS)
            fail(file_, std::string("cannot be put in place: ") + std::strerror(errno));
        require_absent(file_);
        std::filesystem::rename(part_, file_);
    }
    part_.clear();
}

NewFolder::NewFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (folder_.filename().empty()) folder_ = folder_.parent_path();
    require_absent(folder_, true);
    part_ = part_beside(folder_);
    std::error_code error;
    std::filesystem::create_directory(part_, error);
    if (error) fail(folder_, "cannot be made: " + error.message());
}

NewFolder::~NewFolder() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove_all(part_, ignored);
}

void NewFolder::put_in_place() {
    require_absent(folder_, true);
    std::error_code error;
    std::filesystem::rename(part_, folder_, error);
    if (error) fail(folder_, "cannot be put in place: " + error.message());
    part_.clear();
}

}  // namespace planemap
