// SPDX-License-Identifier: BSD-3-Clause
#include "core/files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace planemap {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& doing, int error) {
    throw std::system_error(error, std::generic_category(), file.string() + ": cannot " + doing);
}

/// Writes and closes; with `sync`, waits until the bytes are on the disk. Returns errno's value, 0 if all is
/// well.
int write_through(const std::filesystem::path& file, std::string_view bytes, bool sync) {
    std::FILE* out = std::fopen(file.c_str(), "wb");
    if (out == nullptr) return errno;
    bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size() && std::fflush(out) == 0;
    while (written && sync && ::fsync(::fileno(out)) != 0) written = errno == EINTR;
    const int error = written ? 0 : errno;
    return std::fclose(out) == 0 || error != 0 ? error : errno;
}

}  // namespace

std::string read_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status)) fail(file, "read", EISDIR);
    // To open a pipe would wait for who writes it, perhaps for ever.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw std::runtime_error(file.string() + ": cannot read: not a regular file");
    }
    errno = 0;
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) fail(file, "open", errno != 0 ? errno : ENOENT);
    const auto size = static_cast<std::size_t>(std::max<std::streamoff>(in.tellg(), 0));
    if (size > max_bytes) {
        throw std::runtime_error(file.string() + ": " + std::to_string(size) + " bytes, more than the " +
                                 std::to_string(max_bytes) + " that are read");
    }
    std::string bytes(size, '\0');
    in.seekg(0);
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (in.gcount() != static_cast<std::streamsize>(size)) fail(file, "read", EIO);
    return bytes;
}

void write_file(const std::filesystem::path& file, std::string_view bytes) {
    std::error_code status;
    const std::filesystem::file_type type = std::filesystem::status(file, status).type();
    using Type = std::filesystem::file_type;
    if (type == Type::character || type == Type::fifo || type == Type::socket || type == Type::block) {
        // /dev/stdout or a pipe: there is nothing to replace, and it must stay what it is.
        const int error = write_through(file, bytes, false);
        if (error != 0) fail(file, "write", error);
        return;
    }
    const std::filesystem::path beside = file.string() + ".tmp" + std::to_string(::getpid());
    int error = write_through(beside, bytes, true);
    if (error == 0) {
        std::error_code renamed;
        std::filesystem::rename(beside, file, renamed);
        error = renamed.value();
    }
    if (error != 0) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        fail(file, "write", error);
    }
}

}  // namespace planemap
