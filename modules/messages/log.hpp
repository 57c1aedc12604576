// SPDX-License-Identifier: BSD-3-Clause
// LCM log files, read by our own bounded and resyncing reader: liblcm's crashes on a hostile length, loses
// the event before stray bytes and ends at the first bad record without a word.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messages/log_records.hpp"

namespace planemap::messages {

struct LogEvent {
    std::int64_t number = 0;  ///< event number in the log
    std::int64_t utime = 0;   ///< time of logging, microseconds
    std::string channel;
    std::vector<std::uint8_t> bytes;
};

/// Bytes of a log that belong to no whole event.
struct LogGap {
    std::uint64_t at = 0, bytes = 0;  ///< bytes [at, at + bytes) of the file
    /// About how many events are lost in it: by the event numbers around it where these make sense, else by
    /// the mean size of an event.
    std::int64_t events = 0;
    std::optional<std::int64_t> utime_before, utime_after;  ///< of the good events around it, microseconds
};

/// Reads events in order; skips what is no whole record and says how much and where. A record counts only if
/// a record or the end of the file follows it (see log_records.hpp); an undamaged log gives every event.
/// The time is linear in the file's size, whatever is in it.
class LogReader {
  public:
    static constexpr std::size_t kMaxGaps = 20;  ///< that are kept to be told one by one

    /// Throws std::runtime_error naming file and reason if it cannot be opened or is no regular file.
    explicit LogReader(const std::filesystem::path& file);

    /// False at the end of the file. Throws std::runtime_error naming file, place and reason if reading
    /// fails, or the file became shorter.
    bool next(LogEvent& event);

    std::uint64_t bytes_read() const { return at_; }
    std::uint64_t bytes_total() const { return records_.file().size(); }
    std::uint64_t bytes_skipped() const { return skipped_; }   ///< that belong to no record
    bool truncated() const { return truncated_; }              ///< the last record is cut short
    const std::vector<LogGap>& gaps() const { return gaps_; }  ///< the first kMaxGaps

    /// All that is wrong with what was read so far, a line each, beginning with the file's name; empty if all
    /// is well.
    std::vector<std::string> complaints() const;

  private:
    bool counts(const LogRecord& record);
    std::optional<LogRecord> resume(std::uint64_t from);
    void deliver(const LogRecord& record, LogEvent& event);
    void add_last_gap(std::uint64_t begin);
    void add_gap(std::uint64_t begin, std::uint64_t end, const LogRecord* next);
    std::int64_t lost_between(std::uint64_t bytes, const LogRecord* next) const;

    LogRecords records_;
    std::uint64_t at_ = 0, skipped_ = 0;
    std::uint64_t zeros_ = 0;  ///< skipped at the end: who wrote the log reserved room and did not close it
    std::optional<std::uint64_t> gap_;         ///< where the one that at_ is in began
    std::optional<LogRecord> before_, ahead_;  ///< the last good record; the one that resume() found
    std::uint64_t ahead_from_ = 0;             ///< where the search for it began
    bool nothing_ahead_ = false, truncated_ = false;
    std::vector<LogGap> gaps_;
    std::int64_t gap_count_ = 0, events_ = 0;
    std::int64_t events_lost_ = 0;  ///< in all gaps, about
    std::int64_t misnumbered_ = 0;  ///< between two that are consecutive but for this one's damaged number
    std::optional<std::int64_t> first_utime_, expected_;  ///< expected_: where a number was out of sequence
};

/// One event as the bytes of a log file; logs are these one after the other.
std::string encode_event(const LogEvent& event);

/// Writes events to a file as they come.
class LogWriter {
  public:
    /// Throws std::runtime_error naming file and reason.
    explicit LogWriter(const std::filesystem::path& file);
    void write(const LogEvent& event);
    /// Flushes and closes; throws std::runtime_error if the disk is full. The destructor closes without a
    /// word.
    void close();

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace planemap::messages
