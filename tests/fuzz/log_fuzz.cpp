// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "fuzz/fuzz.hpp"
#include "messages/log.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    messages::LogReader log(file.path());
    messages::LogEvent event;
    std::uint64_t taken = 0, events = 0;
    while (log.next(event)) {
        taken += messages::encode_event(event).size();
        ++events;
        require(log.bytes_read() <= bytes.size(), "an event ends in the file");
    }
    // The sync word of an event that is taken although it is damaged counts as skipped, too.
    const std::uint64_t told = taken + log.bytes_skipped();
    require(told >= bytes.size() && told <= bytes.size() + 4 * events,
            "each byte belongs to an event, or was skipped");
    const auto zeros = std::find_if(bytes.rbegin(), bytes.rend(), [](auto byte) { return byte != 0; });
    require(!log.gaps().empty() || log.bytes_skipped() <= static_cast<std::uint64_t>(zeros - bytes.rbegin()),
            "bytes that were skipped are told as gaps, but for zeros at the end");
    require(log.gaps().empty() || log.bytes_skipped() > 0, "a gap has bytes");
    require(log.gaps().size() <= messages::LogReader::kMaxGaps, "told gaps are bounded");
    require(!log.next(event), "the end stays the end");
    log.complaints();
}

std::vector<std::string> seeds() {
    std::string log, inner;
    for (int i = 0; i < 4; ++i)
        inner += messages::encode_event({i, 1000000 + 5 * i, "INNER", std::vector<std::uint8_t>(9, 1)});
    for (int i = 0; i < 4; ++i) {
        messages::LogEvent event{i, 2000000 + 33333 * i, "OPENNI_FRAME", std::vector<std::uint8_t>(20, 7)};
        if (i == 2) event.bytes.assign(inner.begin(), inner.end());
        log += messages::encode_event(event);
    }
    std::string flipped = log;
    flipped[24] = static_cast<char>(flipped[24] ^ 0x10);
    return {log, log.substr(0, log.size() - 7), "stray" + log, log + std::string(40, '\0'), flipped};
}

}  // namespace planemap::fuzz
