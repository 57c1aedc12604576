// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/message.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    // What is taken can be sent in today's format.
    fuzz_message<earlier_plane_map_t>(bytes, [](const earlier_plane_map_t& message) {
        messages::from_message(messages::to_message(messages::from_message(message), 0));
    });
}

std::vector<std::string> seeds() {
    return {seed_of(test::sample_earlier_map())};
}

}  // namespace planemap::fuzz
