// SPDX-License-Identifier: BSD-3-Clause
// Whole numbers in as few bytes as they need: seven bits a byte, the lowest first, the eighth says that more
// follow. Signed ones as 0, -1, 1, -2, 2 ... (zigzag).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "messages/checks.hpp"

namespace planemap::messages {

class VarintWriter {
  public:
    void put(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
        bytes_.push_back(static_cast<std::uint8_t>(value));
    }
    void put_signed(std::int64_t value) {
        put(static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
    }
    std::vector<std::uint8_t> take() { return std::move(bytes_); }

  private:
    std::vector<std::uint8_t> bytes_;
};

/// Reads what a VarintWriter wrote; throws MessageError naming the field when the bytes end within a number,
/// or one has more than 49 bits.
class VarintReader {
  public:
    explicit VarintReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::size_t left() const { return bytes_.size() - at_; }

    std::uint64_t get(const char* field) {
        constexpr int kMostBits = 49;
        std::uint64_t value = 0;
        for (int shift = 0; shift < kMostBits; shift += 7) {
            require(left() > 0, field, "is cut short");
            const std::uint64_t byte = bytes_[at_++];
            value |= (byte & 0x7f) << shift;
            if (byte < 0x80) return value;
        }
        fail(field, "has more than 49 bits");
    }
    std::int64_t get_signed(const char* field) {
        const std::uint64_t value = get(field);
        return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
    }
    /// How many of something follow, each of at least so many bytes: never more than there is room for.
    std::size_t count(const char* field, std::size_t least_bytes) {
        const std::uint64_t count = get(field);
        if (count > left() / least_bytes)
            fail(field, "are " + std::to_string(count) + ", " + std::to_string(left()) + " bytes are left");
        return static_cast<std::size_t>(count);
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace planemap::messages
