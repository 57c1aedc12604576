// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/message.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_value<acceleration_t>(bytes);
}

std::vector<std::string> seeds() {
    return {seed_of(messages::to_message(Acceleration{5, {0.1, -9.8, 0.2}}))};
}

}  // namespace planemap::fuzz
