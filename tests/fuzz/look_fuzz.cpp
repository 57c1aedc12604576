// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/message.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_value<look_t>(bytes, 0);
}

std::vector<std::string> seeds() {
    return {seed_of(messages::to_message(test::sample_look(), 1))};
}

}  // namespace planemap::fuzz
