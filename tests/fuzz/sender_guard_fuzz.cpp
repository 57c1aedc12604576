// SPDX-License-Identifier: BSD-3-Clause
// Who sent what: a sequence of messages of any numbers, times and senders, 19 bytes each.
#include <algorithm>
#include <cstring>

#include "fuzz/fuzz.hpp"
#include "messages/sender_guard.hpp"

namespace planemap::fuzz {

namespace {

constexpr std::size_t kBytes = 19;

/// Bits of the first byte say what the message tells; a stamp is one of any, or a small step from the last.
messages::SenderGuard::Message message_of(Bytes bytes, std::int64_t& last_utime, std::uint32_t& last_seq) {
    const auto number = [&](std::size_t at, std::size_t count) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
        return value;
    };
    const std::uint8_t tells = bytes[0];
    messages::SenderGuard::Message message;
    if (tells & 1) message.sender = bytes[1] % 3;
    if (tells & 2) message.kind = bytes[2] % 2;
    if (tells & 4) {
        const auto seq = static_cast<std::uint32_t>(number(3, 4));
        last_seq = tells & 8 ? seq : last_seq + seq % 4;
        message.seq = last_seq;
    }
    if (tells & 16) {
        std::int64_t stamp = 0;
        const std::uint64_t bits = number(7, 8);
        std::memcpy(&stamp, &bits, sizeof(stamp));
        constexpr std::int64_t kFarthest = std::int64_t{1} << 60;  // what messages are checked for
        last_utime = tells & 32 ? stamp % kFarthest : std::min(last_utime + stamp % 70000, kFarthest);
        last_utime = std::max(last_utime, -kFarthest);
        message.utime = last_utime;
    }
    message.checksum = static_cast<std::uint32_t>(number(15, 4));
    return message;
}

}  // namespace

void fuzz(Bytes bytes) {
    messages::SenderGuard guard("FUZZ");
    std::int64_t last_utime = 0;
    std::uint32_t last_seq = 0;
    for (int i = 0; bytes.size() >= kBytes; ++i, bytes = bytes.subspan(kBytes)) {
        const auto verdict = guard.judge(message_of(bytes, last_utime, last_seq));
        require(i > 0 || verdict == messages::SenderGuard::Verdict::kTake, "the first one is followed");
    }
}

std::vector<std::string> seeds() {
    std::string stream;
    for (int i = 0; i < 12; ++i) {
        std::string message(kBytes, '\0');
        message[0] = 1 | 2 | 4 | 16;
        message[1] = static_cast<char>(i % 4 == 3);
        message[6] = 1;
        message[13] = static_cast<char>(0x70);
        message[18] = static_cast<char>(i);
        stream += message;
    }
    return {stream};
}

}  // namespace planemap::fuzz
