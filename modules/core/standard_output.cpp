// SPDX-License-Identifier: BSD-3-Clause
#include "core/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace planemap {

void print(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    finish_printing();
}

void finish_printing() {
    errno = 0;
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
    throw std::runtime_error(std::string("standard output: cannot be written") +
                             (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace planemap
