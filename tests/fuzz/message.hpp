// SPDX-License-Identifier: BSD-3-Clause
// Harnesses of message types.
#pragma once

#include "fuzz/fuzz.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

using test::encoded;

/// The type's fingerprint, 8 bytes; harnesses put it before their input, which then need not find it.
template <typename T>
std::vector<std::uint8_t> fingerprint() {
    std::vector<std::uint8_t> bytes(8);
    const auto hash = static_cast<std::uint64_t>(T::getHash());
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(hash >> (56 - 8 * i));
    return bytes;
}

template <typename T>
std::string seed_of(const T& message) {
    const std::vector<std::uint8_t> bytes = encoded(message);
    return {bytes.begin() + 8, bytes.end()};
}

/// Decodes a message of the type; what is taken must encode to the same bytes again. `use` is given it, and
/// may throw MessageError for a message that makes no sense.
template <typename T, typename Use>
void fuzz_message(Bytes bytes, const Use& use) {
    std::vector<std::uint8_t> whole = fingerprint<T>();
    whole.insert(whole.end(), bytes.begin(), bytes.end());
    try {
        const T message = messages::decode<T>(whole);
        // Not byte by byte: a boolean, or the length of a string, may be written in more than one way.
        require(encoded(message).size() <= whole.size(), "what was decoded is no longer than its bytes");
        use(message);
    } catch (const messages::MessageError&) {
    }
}

/// With the value that it stands for, which must survive the way there and back.
template <typename T, typename... Extra>
void fuzz_value(Bytes bytes, Extra... extra) {
    fuzz_message<T>(bytes, [&](const T& message) {
        const auto value = messages::from_message(message);
        messages::from_message(messages::decode<T>(encoded(messages::to_message(value, extra...))));
    });
}

}  // namespace planemap::fuzz
