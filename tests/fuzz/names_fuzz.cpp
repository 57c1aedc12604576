// SPDX-License-Identifier: BSD-3-Clause
// What a user writes on the command line: LCM URLs, the simulator's names, time stamps, channel prefixes.
#include <stdexcept>

#include "core/stamp.hpp"
#include "fuzz/fuzz.hpp"
#include "messages/bus.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::fuzz {

namespace {

template <typename Read>
void refused_or_read(const Read& read) {
    try {
        read();
    } catch (const std::invalid_argument&) {
    } catch (const std::runtime_error&) {
    }
}

}  // namespace

void fuzz(Bytes bytes) {
    const std::string text(as_text(bytes));
    // A log may be any file of this machine, and is not what is tested here.
    if (text.rfind("file://", 0) != 0) refused_or_read([&] { messages::Endpoint endpoint(text); });
    refused_or_read([&] { simulator::parse_simulator_name(text); });
    refused_or_read([&] { messages::Bus bus("memq://", text); });
    read_stamp(text);
}

std::vector<std::string> seeds() {
    return {};
}

}  // namespace planemap::fuzz
