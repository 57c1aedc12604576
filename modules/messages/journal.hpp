// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "messages/log.hpp"

namespace planemap::messages {

/// The messages that made a module what it is, in a file that outlives it: an LCM log, so that every tool for
/// logs reads it. A message is with the kernel when add() returns, and on the disk a second later: a process
/// that is killed loses nothing that it took, a power cut one second. One process at a time has a journal.
///
/// A disk that is full or fails ends nothing: what could not be written is counted, and trouble() says so.
class Journal {
  public:
    /// Opens the file, or makes it and its folder. A record at its end that was not written whole is cut off.
    /// Throws std::runtime_error naming file and reason if that fails, or another process has it.
    explicit Journal(const std::filesystem::path& file);
    /// Syncs what is not on the disk yet.
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// Gives each message in the order in which they were added; returns how many. What is no whole record in
    /// the middle of the file (damage) is left out and said in complaints().
    std::int64_t replay(const std::function<void(const LogEvent&)>& handler);

    void add(std::string_view channel, std::span<const std::uint8_t> bytes);

    /// Whether the file is so much larger than after the last compact() that another one is worth it.
    bool is_due_to_compact() const;
    /// Writes the journal anew with the messages for which `keep` says so, which may change them; beside and
    /// renamed. What fails leaves the journal as it was.
    void compact(const std::function<bool(LogEvent&)>& keep);

    const std::filesystem::path& file() const { return path_; }
    std::uint64_t bytes() const { return bytes_; }
    /// What keeps messages from the disk, for the status; empty if all is well.
    std::string trouble() const;
    /// The same, if it is another one than the last time it was asked.
    std::optional<std::string> news();
    /// What was wrong with the file when it was opened, a line each.
    const std::vector<std::string>& complaints() const { return complaints_; }

  private:
    void open();
    void cut_torn_tail();
    void write(std::span<const std::uint8_t> bytes);
    void fail(const std::string& what, int error);
    void sync_until(const std::stop_token& stop);

    std::filesystem::path path_;
    int file_ = -1;
    std::uint64_t bytes_ = 0, compacted_bytes_ = 0;
    std::int64_t number_ = 0;  ///< of the next record
    std::vector<std::string> complaints_;
    std::string told_;  ///< by news()

    mutable std::mutex mutex_;  ///< guards what the syncing thread uses: file_, dirty_, trouble_, unwritten_
    std::condition_variable_any changed_;
    bool dirty_ = false;
    std::string trouble_;
    std::int64_t unwritten_ = 0;
    std::jthread syncing_;  ///< last: it uses all of the above
};

}  // namespace planemap::messages
