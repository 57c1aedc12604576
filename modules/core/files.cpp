// SPDX-License-Identifier: BSD-3-Clause
#include "core/files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace planemap {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& doing, int error) {
    throw std::runtime_error(file.string() + ": cannot " + doing + ": " + std::strerror(error));
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
    const std::filesystem::path beside = file.string() + ".tmp" + std::to_string(::getpid());
    std::FILE* out = std::fopen(beside.c_str(), "wb");
    if (out == nullptr) fail(file, "write", errno);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size() &&
                         std::fflush(out) == 0 && ::fsync(::fileno(out)) == 0;
    const int error = errno;
    std::fclose(out);
    std::error_code renamed;
    if (written) std::filesystem::rename(beside, file, renamed);
    if (!written || renamed) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        fail(file, "write", written ? renamed.value() : error);
    }
}

}  // namespace planemap
