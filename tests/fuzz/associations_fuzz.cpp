// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "fuzz/fuzz.hpp"
#include "sensor/image_list.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    try {
        std::optional<std::int64_t> last;
        for (const auto& entry : sensor::read_associations(file.path()).entries) {
            require(!last || entry.depth.utime > *last, "in order of time, each moment once");
            last = entry.depth.utime;
        }
    } catch (const std::runtime_error&) {
    }
}

std::vector<std::string> seeds() {
    return {};
}

}  // namespace planemap::fuzz
