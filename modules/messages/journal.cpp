// SPDX-License-Identifier: BSD-3-Clause
#include "messages/journal.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include "messages/bus.hpp"

namespace planemap::messages {

namespace {

constexpr std::chrono::seconds kSyncPeriod{1};
/// A journal is written anew once it is this much larger than it was after the last time.
constexpr std::uint64_t kGrowthFactor = 2, kGrowthBytes = std::uint64_t{4} << 20;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what, int error) {
    throw std::runtime_error(file.string() + ": " + what + ": " + std::strerror(error));
}

/// Writes all; the errno of what failed, else 0.
int write_all(int file, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return 0;
}

std::filesystem::path beside(std::filesystem::path file) {
    return file += ".new";
}

std::span<const std::uint8_t> as_bytes(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Journal::Journal(const std::filesystem::path& file) : path_(file) {
    if (!path_.parent_path().empty()) {
        std::error_code error;
        std::filesystem::create_directories(path_.parent_path(), error);
        if (error) refuse(path_.parent_path(), "the folder of the state cannot be made", error.value());
    }
    open();
    ::unlink(beside(path_).c_str());  // of a compact() that a kill ended
    cut_torn_tail();
    compacted_bytes_ = bytes_;
    syncing_ = std::jthread([this](const std::stop_token& stop) { sync_until(stop); });
}

Journal::~Journal() {
    syncing_.request_stop();
    syncing_.join();
    ::close(file_);
}

void Journal::open() {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0) refuse(path_, "cannot be opened", errno);
    if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    const int error = errno;
    ::close(file_);
    if (error == EWOULDBLOCK)
        throw std::runtime_error(path_.string() + ": another process goes on with this state");
    refuse(path_, "cannot be locked", error);
}

/// What is after the last whole record was being written when the process ended.
void Journal::cut_torn_tail() {
    LogReader log(path_);
    std::uint64_t end = 0;
    for (LogEvent event; log.next(event);) {
        end = log.bytes_read();
        number_ = std::max(number_, event.number + 1);
    }
    const std::uint64_t torn = log.bytes_total() - end;
    if (torn > 0) {
        complaints_.push_back(path_.string() + ": its last record was not written whole; " +
                              std::to_string(torn) + " bytes cut off");
        if (::ftruncate(file_, static_cast<off_t>(end)) != 0) refuse(path_, "cannot be cut", errno);
    }
    if (log.bytes_skipped() > torn)
        complaints_.push_back(path_.string() + ": " + std::to_string(log.bytes_skipped() - torn) +
                              " damaged bytes in it are left out");
    bytes_ = end;
}

std::int64_t Journal::replay(const std::function<void(const LogEvent&)>& handler) {
    LogReader log(path_);
    std::int64_t count = 0;
    for (LogEvent event; log.next(event); ++count) handler(event);
    return count;
}

void Journal::add(std::string_view channel, std::span<const std::uint8_t> bytes) {
    LogEvent event;
    event.number = number_++;
    event.utime = now_us();
    event.channel = channel;
    event.bytes.assign(bytes.begin(), bytes.end());
    const std::string record = encode_event(event);
    const std::lock_guard lock(mutex_);
    write(as_bytes(record));
}

/// Appends a record, or nothing of it.
void Journal::write(std::span<const std::uint8_t> record) {
    if (const int error = write_all(file_, record)) {
        ++unwritten_;
        fail("cannot be written", error);
        if (::ftruncate(file_, static_cast<off_t>(bytes_)) != 0) fail("cannot be cut", errno);
        return;
    }
    bytes_ += record.size();
    dirty_ = true;
    if (!trouble_.empty()) spdlog::info("{} is written again", path_.string());
    trouble_.clear();
    changed_.notify_all();
}

void Journal::fail(const std::string& what, int error) {
    const std::string why = path_.string() + " " + what + ": " + std::strerror(error);
    if (trouble_ != why) spdlog::warn("{}; what is not in it will be missing after a restart", why);
    trouble_ = why;
}

std::string Journal::trouble() const {
    const std::lock_guard lock(mutex_);
    if (trouble_.empty() && unwritten_ == 0) return {};
    return (trouble_.empty() ? path_.string() : trouble_) +
           "; messages missing in it: " + std::to_string(unwritten_);
}

std::optional<std::string> Journal::news() {
    std::string now = trouble();
    if (now == told_) return std::nullopt;
    return told_ = std::move(now);
}

bool Journal::is_due_to_compact() const {
    return bytes_ > kGrowthFactor * compacted_bytes_ + kGrowthBytes;
}

void Journal::compact(const std::function<bool(LogEvent&)>& keep) {
    const std::filesystem::path newer = beside(path_);
    const int file = ::open(newer.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    int error = file < 0 ? errno : 0;
    std::uint64_t written = 0;
    if (error == 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0) error = errno;
    replay([&](const LogEvent& event) {
        LogEvent kept = event;
        if (error != 0 || !keep(kept)) return;
        const std::string record = encode_event(kept);
        error = write_all(file, as_bytes(record));
        written += record.size();
    });
    if (error == 0 && ::fdatasync(file) != 0) error = errno;
    if (error == 0 && ::rename(newer.c_str(), path_.c_str()) != 0) error = errno;
    const std::lock_guard lock(mutex_);
    if (error != 0) {
        fail("cannot be made smaller", error);
        if (file >= 0) ::close(file);
        ::unlink(newer.c_str());
        compacted_bytes_ = bytes_;  // not again at once
        return;
    }
    ::close(file_);
    file_ = file;
    bytes_ = compacted_bytes_ = written;
}

void Journal::sync_until(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    for (;;) {
        const bool more = changed_.wait(lock, stop, [this] { return dirty_; });
        if (!more) return;
        dirty_ = false;
        const int file = ::fcntl(file_, F_DUPFD_CLOEXEC, 0);  // compact() may close file_ meanwhile
        lock.unlock();
        const int error = file < 0 || ::fdatasync(file) == 0 ? 0 : errno;
        if (file >= 0) ::close(file);
        lock.lock();
        if (error != 0) fail("cannot be synced", error);
        changed_.wait_for(lock, stop, kSyncPeriod, [] { return false; });
    }
}

}  // namespace planemap::messages
