// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log_records.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace planemap::messages {

namespace {

constexpr std::uint32_t kMaxChannel = 999;      // as liblcm's reader; its senders stop at 63
constexpr std::uint32_t kMaxData = 0x7fffffff;  // liblcm's length is signed
constexpr std::array<std::uint8_t, 4> kSyncBytes{0xED, 0xA1, 0xDA, 0x01};
constexpr int kDamagedSyncBits = 3;  // of 32: random bytes are that near once in 800,000 times

template <typename T>
T big_endian(const std::uint8_t* bytes) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | bytes[i]);
    return value;
}

struct Header {
    explicit Header(const std::uint8_t* bytes)
        : sync(big_endian<std::uint32_t>(bytes)),
          channel_length(big_endian<std::uint32_t>(bytes + 20)),
          data_length(big_endian<std::uint32_t>(bytes + 24)),
          number(static_cast<std::int64_t>(big_endian<std::uint64_t>(bytes + 4))),
          utime(static_cast<std::int64_t>(big_endian<std::uint64_t>(bytes + 12))) {}
    bool bounded() const {
        return channel_length > 0 && channel_length <= kMaxChannel && data_length <= kMaxData;
    }
    std::uint64_t size() const { return LogRecords::kHeader + channel_length + data_length; }

    std::uint32_t sync, channel_length, data_length;
    std::int64_t number, utime;
};

/// True if one flipped bit of a length explains that a record is `excess` bytes too long.
bool one_bit_too_long(const LogRecord& record, std::uint64_t excess) {
    return std::has_single_bit(excess) && ((record.channel_length | record.data_length) & excess) != 0;
}

/// True if `number` is that of an event that comes after `last` within so many bytes.
bool in_sequence(std::int64_t number, std::int64_t last, std::uint64_t bytes) {
    return number > last && static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(last) <=
                                bytes / LogRecords::kSmallest + 2;
}

}  // namespace

std::optional<LogRecord> LogRecords::at(std::uint64_t place) {
    if (place + kHeader > file_.size()) return std::nullopt;
    std::array<std::uint8_t, kHeader> bytes;
    file_.peek(place, bytes);
    const Header header(bytes.data());
    if (!header.bounded() || header.size() > file_.size() - place) return std::nullopt;
    std::array<std::uint8_t, kMaxChannel> channel;
    file_.peek(place + kHeader, std::span(channel).first(header.channel_length));
    if (std::memchr(channel.data(), 0, header.channel_length) != nullptr) return std::nullopt;
    return LogRecord{place,
                     place + header.size(),
                     header.number,
                     header.utime,
                     header.channel_length,
                     header.data_length,
                     header.sync == kSync};
}

std::optional<LogRecord> LogRecords::synced_at(std::uint64_t place) {
    auto record = at(place);
    return record && record->synced ? record : std::nullopt;
}

bool LogRecords::cut_short(std::uint64_t place) {
    std::array<std::uint8_t, kHeader> bytes;
    const auto left = static_cast<std::size_t>(std::min<std::uint64_t>(file_.size() - place, kHeader));
    file_.peek(place, std::span(bytes).first(left));
    if (std::memcmp(bytes.data(), kSyncBytes.data(), std::min(left, kSyncBytes.size())) != 0) return false;
    if (left < kHeader) return left > 0;
    const Header header(bytes.data());
    return header.bounded() && header.size() > file_.size() - place;
}

/// With damage: what stands there may be the header of the event with the expected number, damaged in part.
/// Each of the signs is next to impossible in bytes that are none.
bool LogRecords::record_begins(std::uint64_t place, bool with_damage, std::int64_t expected_number) {
    const std::uint64_t left = file_.size() - place;
    if (left < kSyncBytes.size()) return left == 0 || cut_short(place);
    std::array<std::uint8_t, kHeader> bytes{};
    file_.peek(place, std::span(bytes).first(with_damage && left >= kHeader ? kHeader : kSyncBytes.size()));
    const Header header(bytes.data());
    if (header.sync == kSync) return true;
    if (!with_damage) return false;
    if (std::popcount(header.sync ^ kSync) <= kDamagedSyncBits) return true;
    if (left < kHeader) return false;
    if (header.number == expected_number) return true;
    const auto record = at(place);
    return record && record_begins(record->end, false, 0);
}

bool LogRecords::followed(const LogRecord& record) {
    return record_begins(record.end, true, following(record.number));
}

std::optional<LogRecord> LogRecords::first_inside(const LogRecord& record) {
    const std::uint64_t begin = record.at + kHeader;
    for (std::uint64_t place = file_.find(kSyncBytes, begin, record.end); place < record.end;
         place = file_.find(kSyncBytes, place + 1, record.end)) {
        if (const auto inside = at(place)) return inside;
    }
    return std::nullopt;
}

bool LogRecords::swallows(const LogRecord& record) {
    const auto next = synced_at(record.end);
    if (next && next->number == following(record.number)) return false;
    const auto first = first_inside(record);
    if (!first || first->number != following(record.number) || first->utime < record.utime ||
        !one_bit_too_long(record, record.end - first->at)) {
        return false;
    }
    auto inside = first;
    while (inside->end < record.end) {
        const auto after = synced_at(inside->end);
        if (!after || after->number != following(inside->number)) return false;
        inside = after;
    }
    return inside->end == record.end && (!next || next->number == following(inside->number));
}

bool LogRecords::holds_log(const LogRecord& record) {
    auto inside = first_inside(record);
    if (!inside || inside->number == following(record.number)) return false;  // rather the next event
    while (inside && inside->end < record.end) inside = synced_at(inside->end);
    return inside && inside->end == record.end;
}

bool LogRecords::before_stray_bytes(const LogRecord& record, std::uint64_t next) {
    std::array<std::uint8_t, 1 + 16> around{};  // the record's last byte, and what comes
    const std::uint64_t stray = next - record.end;
    const std::size_t n = 1 + static_cast<std::size_t>(std::min<std::uint64_t>(16, stray));
    file_.peek(record.end - 1, std::span(around).first(n));
    const auto behind = std::span(around).subspan(1, n - 1);
    std::size_t synced = 0;
    while (synced < std::min(behind.size(), kSyncBytes.size()) && behind[synced] == kSyncBytes[synced])
        ++synced;
    if (synced > 0 && synced == stray) return true;
    const auto fill = behind.subspan(synced);
    return fill.size() >= 8 && around[synced] != fill[0] &&
           std::all_of(fill.begin(), fill.end(), [&](std::uint8_t byte) { return byte == fill[0]; });
}

/// The record after a log inside a damaged payload that begins with `first`; nothing if that is no such log.
std::optional<LogRecord> LogRecords::outer(const LogRecord& first, std::uint64_t gap, std::int64_t last) {
    LogRecord record = first;
    while (true) {
        const auto next = synced_at(record.end);
        if (!next) return std::nullopt;
        if (next->number != following(record.number)) {
            const bool fits = in_sequence(next->number, last, next->at - gap);
            const bool between = first.number > last && first.number < next->number;
            return fits && !between && followed(*next) ? next : std::nullopt;
        }
        record = *next;
    }
}

std::optional<LogRecord> LogRecords::resume(std::uint64_t gap, std::uint64_t from,
                                            std::optional<std::int64_t> last) {
    const std::uint64_t size = file_.size();
    std::optional<LogRecord> unsure;  // that nothing follows: the last one before the next that is followed
    for (std::uint64_t place = file_.find(kSyncBytes, from, size); place < size;
         place = file_.find(kSyncBytes, place + 1, size)) {
        const auto record = at(place);
        if (!record) continue;
        if (!followed(*record)) {
            unsure = record;
            continue;
        }
        if (unsure && unsure->end <= place && before_stray_bytes(*unsure, place)) return unsure;
        if (!last || in_sequence(record->number, *last, place - gap)) return record;
        const auto beyond = outer(*record, gap, *last);
        return beyond ? beyond : record;
    }
    return unsure && before_stray_bytes(*unsure, size) ? unsure : std::nullopt;
}

}  // namespace planemap::messages
