// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/message.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_value<seen_space_t>(bytes, 0, 0);
}

std::vector<std::string> seeds() {
    return {seed_of(messages::to_message(test::sample_seen_space(), 1, 2))};
}

}  // namespace planemap::fuzz
