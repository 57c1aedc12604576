// SPDX-License-Identifier: BSD-3-Clause
// Where the records of an LCM log are, in a log that may be damaged. A record is u32 0xEDA1DA01, i64 event
// number, i64 microseconds, u32 channel length, u32 data length, channel, data; all big-endian. A sync word
// alone proves nothing (payloads hold whole logs, and stray words happen), and neither do lengths (one
// flipped bit swallows dozens of records): what proves a record is what comes behind it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "messages/file_bytes.hpp"

namespace planemap::messages {

/// A record's header, with lengths that may be right: the channel holds no NUL, the end lies in the file.
struct LogRecord {
    std::uint64_t at = 0, end = 0;  ///< bytes [at, end) of the file
    std::int64_t number = 0, utime = 0;
    std::uint32_t channel_length = 0, data_length = 0;
    bool synced = false;  ///< it begins with the sync word
};

/// The number of the event after this one.
inline std::int64_t following(std::int64_t number) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(number) + 1);
}

class LogRecords {
  public:
    static constexpr std::uint64_t kHeader = 4 + 8 + 8 + 4 + 4;
    static constexpr std::uint64_t kSmallest = kHeader + 1;  ///< a channel of one character, no data
    static constexpr std::uint32_t kSync = 0xEDA1DA01;

    explicit LogRecords(const std::filesystem::path& file) : file_(file) {}

    FileBytes& file() { return file_; }
    const FileBytes& file() const { return file_; }

    /// What may be a record at a place.
    std::optional<LogRecord> at(std::uint64_t place);
    /// True if a record begins at a place but the file ends before it does.
    bool cut_short(std::uint64_t place);

    /// True if the file ends or a record begins where this one ends, be that one's header damaged in part.
    bool followed(const LogRecord& record);
    /// True if the lengths of a record that is followed must be wrong all the same: one flipped bit made it
    /// end where a later record ends, which shows in the event numbers.
    bool swallows(const LogRecord& record);
    /// True if a log in its payload ends just where the record does, so that its lengths are right.
    bool holds_log(const LogRecord& record);
    /// Of a record that nothing follows, with no record inside, and the next one at `next` (or the file's
    /// end): true if it is whole all the same, since what lies between shows it: the next record was cut in
    /// its sync word, or a fill, such as the zeros that a crash leaves, begins just where this one ends.
    /// Other stray bytes may as well be the rest of it.
    bool before_stray_bytes(const LogRecord& record, std::uint64_t next);

    /// The first record from `from` on that is followed. `last` is the number of the last good event before
    /// `gap`, where the damage begins: records of a log inside the damaged record, known by their numbers,
    /// are passed over.
    std::optional<LogRecord> resume(std::uint64_t gap, std::uint64_t from, std::optional<std::int64_t> last);

  private:
    bool record_begins(std::uint64_t place, bool with_damage, std::int64_t expected_number);
    std::optional<LogRecord> outer(const LogRecord& first, std::uint64_t gap, std::int64_t last);
    std::optional<LogRecord> synced_at(std::uint64_t place);
    std::optional<LogRecord> first_inside(const LogRecord& record);

    FileBytes file_;
};

}  // namespace planemap::messages
