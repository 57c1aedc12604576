// SPDX-License-Identifier: BSD-3-Clause
// The types of which no module makes a value; the first byte chooses.
#include <bot_core/pose_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>

#include "fuzz/message.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    if (bytes.empty()) return;
    const auto nothing = [](const auto&) {};
    switch (bytes[0] % 3) {
        case 0:
            return fuzz_message<bot_core::pose_t>(bytes.subspan(1), nothing);
        case 1:
            return fuzz_message<map_size_t>(bytes.subspan(1), nothing);
        default:
            return fuzz_message<module_status_t>(bytes.subspan(1), nothing);
    }
}

std::vector<std::string> seeds() {
    module_status_t status{};
    status.module = "MAP";
    status.text = "12 planes";
    return {std::string(1, '\0') + seed_of(bot_core::pose_t{}), "\1" + seed_of(map_size_t{}),
            "\2" + seed_of(status)};
}

}  // namespace planemap::fuzz
