// SPDX-License-Identifier: BSD-3-Clause
#include "results/host.hpp"

#include <sys/utsname.h>

#include <fstream>

namespace planemap {

std::optional<std::string> host_name() {
    utsname name = {};
    if (uname(&name) != 0 || name.nodename[0] == '\0') return std::nullopt;
    return name.nodename;
}

std::optional<std::string> cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("model name")) continue;
        const std::size_t at = line.find_first_not_of(" \t", line.find(':') + 1);
        if (at != std::string::npos) return line.substr(at);
    }
    return std::nullopt;
}

}  // namespace planemap
