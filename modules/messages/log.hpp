// SPDX-License-Identifier: BSD-3-Clause
// LCM log files, read by our own bounded and resyncing reader: liblcm's crashes on a hostile length, loses
// the event before stray bytes and ends at the first bad record without a word.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace planemap {

struct LogEvent {
    std::int64_t number = 0;  ///< event number in the log
    std::int64_t utime = 0;   ///< time of logging, microseconds
    std::string channel;
    std::vector<std::uint8_t> bytes;
};

/// Reads events in order; skips what is no record and says how much.
class LogReader {
  public:
    /// Throws std::runtime_error naming file and reason if it cannot be opened.
    explicit LogReader(const std::filesystem::path& file);

    /// False at the end of the file.
    bool next(LogEvent& event);

    std::uint64_t bytes_read() const { return at_; }
    std::uint64_t bytes_total() const { return size_; }
    std::uint64_t bytes_skipped() const { return skipped_; }  ///< that belong to no record
    bool truncated() const { return truncated_; }             ///< the last record is cut short

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    bool read_record(LogEvent& event);

    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t size_ = 0, at_ = 0, skipped_ = 0;
    bool truncated_ = false;
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

}  // namespace planemap
