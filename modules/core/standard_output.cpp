// SPDX-License-Identifier: BSD-3-Clause
#include "core/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace planemap {

namespace {

[[noreturn]] void fail(int error) {
    throw std::runtime_error(std::string("standard output: cannot be written") +
                             (error != 0 ? std::string(": ") + std::strerror(error) : ""));
}

}  // namespace

void print(std::string_view text) {
    errno = 0;
    if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) fail(errno);
    finish_printing();
}

void finish_printing() {
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail(errno);
}

}  // namespace planemap
