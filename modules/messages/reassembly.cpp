// SPDX-License-Identifier: BSD-3-Clause
#include "messages/reassembly.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace planemap::messages {

std::optional<std::int64_t> failed_reassemblies(const std::filesystem::path& snmp) {
    std::ifstream file(snmp);
    std::string names;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("Ip: ")) continue;
        if (names.empty()) {
            names = line;
            continue;
        }
        std::istringstream name_words(names), value_words(line);
        std::string name, value;
        while (name_words >> name && value_words >> value) {
            std::int64_t count = 0;
            if (name == "ReasmFails" && std::istringstream(value) >> count) return count;
        }
        return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace planemap::messages
